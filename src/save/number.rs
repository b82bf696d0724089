//! Numbers as files have them: few digits, and read back as the same f32.

use glam::Vec3;
use std::fmt::{self, Display, Formatter};

/// An f32 in digits that bring it back by way of f64, which is how loaders read numbers.
#[derive(Clone, Copy)]
pub(super) struct Digits(pub(super) f32);

impl Display for Digits {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // Counts that an f32 holds exactly need no point; TOML reads -0 as a whole number, without its sign.
        const ALL_WHOLE: f32 = 16_777_216.0;
        let value = self.0;
        if value.trunc() == value && value.abs() < ALL_WHOLE && (value != 0.0 || value.is_sign_positive()) {
            return write!(f, "{value}");
        }
        // The shortest digits of an f32 are meant to be read as an f32. For a few numbers in all, reading them as an f64 and
        // rounding that leads to a neighbour; the digits of the f64 never do.
        let digits = format!("{value:?}");
        match digits.parse::<f64>() {
            Ok(read) if rounded(read) == value => f.write_str(&digits),
            _ => write!(f, "{:?}", f64::from(value)),
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the rounding that loaders do")]
pub(super) fn rounded(value: f64) -> f32 {
    value as f32
}

/// Three numbers with something between them.
pub(super) struct Triple<'a>(pub(super) Vec3, pub(super) &'a str);

impl Display for Triple<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self(Vec3 { x, y, z }, between) = *self;
        write!(f, "{}{between}{}{between}{}", Digits(x), Digits(y), Digits(z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text(value: f32) -> String {
        Digits(value).to_string()
    }

    #[test]
    fn digits_are_few() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "-0.0"),
            (1.0, "1"),
            (-2048.0, "-2048"),
            (0.1, "0.1"),
            (1.0 / 3.0, "0.33333334"),
            (1e-7, "1e-7"),
            (1e18, "1e18"),
        ] {
            assert_eq!(text(value), expected);
        }
    }

    /// These digits mean one f32 when they are read as an f32, and its neighbour by way of an f64.
    #[test]
    fn digits_that_an_f64_would_lead_astray_are_not_used() {
        let value: f32 = "7.038531e-26".parse().unwrap();
        assert_ne!(rounded("7.038531e-26".parse().unwrap()), value, "the case that this test is about");
        assert_eq!(rounded(text(value).parse().unwrap()), value);
    }

    proptest! {
        #[test]
        fn numbers_come_back(bits: u32) {
            let value = f32::from_bits(bits);
            prop_assume!(value.is_finite());
            let read: f64 = text(value).parse().unwrap();
            prop_assert_eq!(rounded(read).to_bits(), bits);
        }
    }
}
