//! Numbers as the printed trees have them.

/// As few digits as tell this f32 from every other one.
pub(super) fn shortest(value: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "an f32, or a multiple of one by a power of two")]
    let value = value as f32;
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-4..1e9 => format!("{value}"),
        _ => format!("{value:e}"),
    }
}

/// A number in nine significant digits, which tell any two f32 apart; one that is not negative leaves room for a sign.
pub(super) fn significant(value: f64) -> String {
    let sign = if value < 0.0 { '-' } else { ' ' };
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{sign}{size}");
    }
    let scientific = format!("{size:.8e}");
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent.and_then(|exponent| usize::try_from(8 - exponent).ok()) {
        Some(decimals) if decimals <= 11 => format!("{sign}{size:.decimals$}"),
        _ => format!("{sign}{scientific}"),
    }
}

/// A distance in spacings of f32 numbers.
pub(super) fn in_ulps(ulps: f64) -> String {
    match ulps {
        0.0..0.05 => "below 0.1 ulp".to_owned(),
        0.0..9.95 => format!("{ulps:.1} ulp"),
        0.0..1e5 => format!("{ulps:.0} ulp"),
        _ => format!("{ulps:.1e} ulp"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_nine_digits_at_any_size() {
        for (value, expected) in [
            (0.1 + 0.2, " 0.300000000"),
            (-1234.56789, "-1234.56789"),
            (0.00123456789, " 0.00123456789"),
            (1.0e-5 / 3.0, " 3.33333333e-6"),
            (-2.0e12 / 3.0, "-6.66666667e11"),
            (-0.0, " 0"),
            (f64::INFINITY, " inf"),
        ] {
            assert_eq!(significant(value), expected);
        }
    }

    #[test]
    fn a_distance_that_is_there_is_never_said_to_be_0() {
        let said = [1e-9, 0.5, 9.94, 9.96, 1234.5678, 2e7].map(in_ulps);
        assert_eq!(said, ["below 0.1 ulp", "0.5 ulp", "9.9 ulp", "10 ulp", "1235 ulp", "2.0e7 ulp"]);
    }

    #[test]
    fn few_digits_tell_one_f32_from_the_next() {
        for (value, expected) in
            [(0.1_f32, "0.1"), (0.1_f32.next_up(), "0.10000001"), (-2e-7, "-2e-7"), (-0.0, "0")]
        {
            assert_eq!(shortest(f64::from(value)), expected);
        }
    }
}
