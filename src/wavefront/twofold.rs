//! Numbers of twice f64's digits, for tests of what is computed in f64.
//!
//! Sources: Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971; Knuth, "The Art of Computer
//! Programming", volume 2.

use std::ops::{Add, Mul, Neg, Sub};

/// The sum of two f64, the second no more than half a unit in the last place of the first; right to some 2⁻¹⁰⁰ of itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twofold(pub(super) f64, pub(super) f64);

fn sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    let b_part = high - a;
    Twofold(high, (a - (high - b_part)) + (b - b_part))
}

impl From<f64> for Twofold {
    fn from(number: f64) -> Self {
        Self(number, 0.0)
    }
}

impl Add for Twofold {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let Self(high, low) = sum(self.0, other.0);
        let Self(middle, least) = sum(self.1, other.1);
        let Self(high, low) = sum(high, low + middle);
        sum(high, low + least)
    }
}

impl Neg for Twofold {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for Twofold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twofold {
    type Output = Self;

    #[expect(
        clippy::disallowed_methods,
        reason = "the error of a product, in a test; whatever fuses it, it is exact"
    )]
    fn mul(self, other: Self) -> Self {
        let high = self.0 * other.0;
        let low = self.0.mul_add(other.0, -high);
        sum(high, low + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Twofold {
    /// By a whole number below 2⁵³.
    pub(super) fn divided_by(self, divisor: f64) -> Self {
        let first = self.0 / divisor;
        let rest = self - Self::from(first) * Self::from(divisor);
        sum(first, (rest.0 + rest.1) / divisor)
    }

    /// e to this, for magnitudes up to 700.
    pub(super) fn exp(self) -> Self {
        const LN_2: Twofold = Twofold(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
        let halves = (self.0 / LN_2.0).round();
        let rest = self - Self::from(halves) * LN_2;
        let series = (1..=28)
            .rev()
            .fold(Self::from(1.0), |tail, k| Self::from(1.0) + (tail * rest).divided_by(f64::from(k)));
        let power = halves.exp2();
        Self(series.0 * power, series.1 * power)
    }

    /// The natural logarithm of a number > 0, by a step of Newton's from f64's.
    pub(super) fn ln(number: f64) -> Self {
        let near = Self::from(number.ln());
        near + (Self::from(number) * (-near).exp() - Self::from(1.0))
    }

    /// |other − self| / self.
    pub(super) fn relative_error(self, other: f64) -> f64 {
        ((Self::from(other) - self).0 / self.0).abs()
    }
}

#[test]
fn known_digits() {
    // e and ln 10 less their f64, from tables.
    let e = Twofold::from(1.0).exp();
    assert_eq!(e.0, std::f64::consts::E);
    assert!((e.1 / 1.445_646_891_729_250_2e-16 - 1.0).abs() < 1e-12, "{e:?}");
    let ln_10 = Twofold::ln(10.0);
    assert_eq!(ln_10.0, std::f64::consts::LN_10);
    assert!((ln_10.1 / -2.170_756_223_382_249_4e-16 - 1.0).abs() < 1e-12, "{ln_10:?}");
    let third = Twofold::from(1.0).divided_by(3.0);
    let product = third * Twofold::from(3.0) - Twofold::from(1.0);
    assert!((product.0 + product.1).abs() < 1e-31);
}
