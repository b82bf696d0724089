//! Powers and exponentials in f64 lanes, from + − × ÷ and the bits of numbers: the same bits in every build.

use crate::lanes::Double;
use std::f64::consts::{LN_2, LOG2_E, SQRT_2};

/// Of 2 to 13.
#[rustfmt::skip]
const INVERSE_FACTORIALS: [f64; 12] = [
    1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40_320.0, 1.0 / 362_880.0,
    1.0 / 3_628_800.0, 1.0 / 39_916_800.0, 1.0 / 479_001_600.0, 1.0 / 6_227_020_800.0,
];

/// Of 3 to 21.
#[rustfmt::skip]
const INVERSE_ODD_NUMBERS: [f64; 10] = [
    1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0,
];

/// e^x for x ≤ 0, off by at most 2·2⁻⁵³ of itself, less than 2 ulp; 0 below −700, where f32 has long been 0.
#[inline(always)]
pub(super) fn exp<D: Double>(x: D) -> D {
    // The high part has enough zeros at its end for its product with a whole number to be exact. Source: Cody and Waite,
    // "Software Manual for the Elementary Functions", 1980.
    const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let least = D::splat(-700.0);
    let bounded = x.max(least);
    let halves = nearest_whole(bounded * D::splat(LOG2_E));
    let rest = (bounded - halves * D::splat(LN_2_HIGH)) - halves * D::splat(LN_2_LOW);
    // 1 + (rest + rest²·(½ + rest/6 + …)) rounds less than Horner's sum. |rest| ≤ ln 2 / 2: the term after the last is below 2⁻⁵³.
    let sum = D::splat(1.0) + (rest + rest * rest * polynomial(&INVERSE_FACTORIALS, rest));
    D::select(x.lt(least), D::splat(0.0), sum.times_power_of_two(halves))
}

/// x^y for 0 ≤ x ≤ 1 and y ≥ 0, off by at most (3 + 10·y·|ln x|)·2⁻⁵³ of itself; 0⁰ = 1. An x that rounding has taken above 1
/// is no harm.
#[inline(always)]
pub(super) fn pow<D: Double>(x: D, y: D) -> D {
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let is_zero = x.le(zero);
    let at_zero = D::select(y.eq(zero), one, zero);
    let exponent = y * ln(D::select(is_zero, one, x));
    D::select(is_zero, at_zero, exp(exponent))
}

/// The natural logarithm of a positive normal number, off by at most 9·2⁻⁵³ of itself: with x = m·2^e and m around 1,
/// e·ln 2 + 2·atanh((m − 1)/(m + 1)).
#[inline(always)]
fn ln<D: Double>(x: D) -> D {
    let one = D::splat(1.0);
    let (exponent, mantissa) = x.split_exponent();
    let is_large = mantissa.gt(D::splat(SQRT_2));
    let mantissa = D::select(is_large, mantissa * D::splat(0.5), mantissa);
    let exponent = D::select(is_large, exponent + one, exponent);
    let s = (mantissa - one) / (mantissa + one);
    let square = s * s;
    let twice = s + s;
    // |s| ≤ 0.172: the term after the last is below 2⁻⁵³.
    exponent * D::splat(LN_2) + (twice + twice * (square * polynomial(&INVERSE_ODD_NUMBERS, square)))
}

/// Σ cₖ·xᵏ. Even and odd powers apart, so that of two steps neither waits for the other.
#[inline(always)]
fn polynomial<D: Double, const N: usize>(coefficients: &[f64; N], x: D) -> D {
    let square = x * x;
    let zero = D::splat(0.0);
    let (mut even, mut odd) = (zero, zero);
    for k in (0..N).rev() {
        let sum = if k % 2 == 0 { &mut even } else { &mut odd };
        *sum = D::splat(coefficients[k]) + *sum * square;
    }
    even + odd * x
}

/// The nearest whole number, for magnitudes below 2⁵¹: adding and subtracting 1.5·2⁵² rounds to one.
#[inline(always)]
fn nearest_whole<D: Double>(x: D) -> D {
    let shift = D::splat(6_755_399_441_055_744.0);
    (x + shift) - shift
}

#[cfg(test)]
mod tests {
    use super::super::twofold::Twofold;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn limits() {
        assert_eq!([exp(0.0_f64), exp(-1e300), exp(-701.0)], [1.0, 0.0, 0.0]);
        assert_eq!([pow(0.0_f64, 0.0), pow(0.0, 3.0), pow(1.0, 1e9), pow(0.5, 0.0)], [1.0, 0.0, 1.0, 1.0]);
        assert!((pow(0.5_f64, 3.0) - 0.125).abs() <= 0.125 * 4.0 * f64::EPSILON);
    }

    /// 2⁻⁵³.
    const U: f64 = f64::EPSILON / 2.0;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn exponentials_are_within_their_bound_of_twice_the_digits(x in prop_oneof![-700.0..0.0f64, -2.0..0.0f64]) {
            let off = Twofold::from(x).exp().relative_error(exp(x));
            prop_assert!(off <= 2.0 * U, "off by {} of 2^-53", off / U);
        }

        #[test]
        fn logarithms_are_within_their_bound_of_twice_the_digits(
            x in prop_oneof![0.0..1.0f64, 0.5..2.0f64, (-1e-9..1e-9f64).prop_map(|off| 1.0 + off)],
        ) {
            prop_assume!(x > f64::MIN_POSITIVE && x != 1.0);
            let off = Twofold::ln(x).relative_error(ln(x));
            prop_assert!(off <= 9.0 * U, "off by {} of 2^-53", off / U);
        }

        #[test]
        fn powers_are_within_their_bound_of_twice_the_digits(
            x in prop_oneof![0.0..=1.0f64, (0.0..1e-3f64).prop_map(|off| 1.0 - off)],
            y in prop_oneof![0.0..2000.0f64, 0.0..3.0f64],
        ) {
            prop_assume!(x > f64::MIN_POSITIVE);
            let exponent = Twofold::ln(x) * Twofold::from(y);
            // Below, all of it is 0.
            if exponent.0 > -700.0 {
                let off = exponent.exp().relative_error(pow(x, y));
                prop_assert!(off <= (3.0 + 10.0 * exponent.0.abs()) * U, "off by {} of 2^-53", off / U);
            }
        }
    }
}
