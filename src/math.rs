//! Elementary functions from + − × ÷ and comparisons alone, so that every build and processor gives the same bits.
//!
//! The C library's may differ from system to system in the last place; what decides a pixel must not.

/// Sine and cosine of an angle in degrees; exact at multiples of 90°, elsewhere within 2 ulp of 1.
#[must_use]
pub(crate) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // Reduction by whole quarter turns is exact in degrees, unlike in radians: fmod is exact, and so is the difference.
    let turn = degrees % 360.0;
    let quarters = (turn / 90.0).round();
    let radians = (turn - 90.0 * quarters) * (std::f64::consts::PI / 180.0);
    let (sin, cos) = (sin_below_45(radians), cos_below_45(radians));
    match quarters.rem_euclid(4.0) {
        0.0 => (sin, cos),
        1.0 => (cos, -sin),
        2.0 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Taylor's series to x^17: the next term is below 2⁻⁶⁰ for |x| ≤ π/4.
fn sin_below_45(x: f64) -> f64 {
    let square = x * x;
    let series = (1..=8).rev().fold(1.0, |tail, k| {
        let k = f64::from(k);
        1.0 - tail * square / (2.0 * k * (2.0 * k + 1.0))
    });
    x * series
}

/// Taylor's series to x^18, likewise.
fn cos_below_45(x: f64) -> f64 {
    let square = x * x;
    (1..=9).rev().fold(1.0, |tail, k| {
        let k = f64::from(k);
        1.0 - tail * square / (2.0 * k * (2.0 * k - 1.0))
    })
}

/// x^2.4 for 0 ≤ x ≤ 1, within some ulp: x² times the fifth root of x², by Newton's iteration.
#[must_use]
pub(crate) fn pow_2_4(x: f64) -> f64 {
    let square = x * x;
    if square == 0.0 {
        return 0.0;
    }
    // From above the root, Newton's steps for y⁵ = x² fall until rounding stops them.
    let mut root = 1.0;
    loop {
        let fourth = root * root * root * root;
        let next = (4.0 * root + square / fourth) / 5.0;
        if next >= root {
            return square * root;
        }
        root = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact() {
        for (degrees, expected) in [
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (270.0, (-1.0, 0.0)),
            (-90.0, (-1.0, 0.0)),
            (-450.0, (-1.0, 0.0)),
            (720.0, (0.0, 1.0)),
        ] {
            assert_eq!(sin_cos_degrees(degrees), expected, "at {degrees} degrees");
        }
    }

    proptest! {
        #[test]
        fn sine_and_cosine_agree_with_the_c_library(degrees in -1000.0..1000.0f64) {
            let (sin, cos) = sin_cos_degrees(degrees);
            // Reduce before converting to radians: the conversion of a large angle loses more than the series.
            let (sin_std, cos_std) = (degrees % 360.0).to_radians().sin_cos();
            prop_assert!((sin - sin_std).abs() < 2e-15, "sine {sin} against {sin_std}");
            prop_assert!((cos - cos_std).abs() < 2e-15, "cosine {cos} against {cos_std}");
        }

        #[test]
        fn power_agrees_with_the_c_library(x in 0.0..=1.0f64) {
            let (own, std) = (pow_2_4(x), x.powf(2.4));
            prop_assert!((own - std).abs() <= 8.0 * f64::EPSILON * std, "{own} against {std}");
        }
    }
}
