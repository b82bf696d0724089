//! A number of f64 and a bound of its error, kept through every operation (running error analysis: Higham, "Accuracy and
//! Stability of Numerical Algorithms", §3.3).
//!
//! With u = 2⁻⁵³, f64 rounds to nearest: fl(x) = x + δ, |δ| ≤ u·|fl(x)|, and by at most 2⁻¹⁰⁷⁵ where the result is subnormal.
//! Bounds are themselves computed in f64, from numbers ≥ 0 by at most nine operations that may each lose a share u of them;
//! [`GROWN`] puts 16u back. What overflows, or is no number, has a bound that decides nothing.

use super::Enclosure;
use super::number::Number;
use std::cmp::Ordering;

/// |truth − value| ≤ error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    value: f64,
    error: f64,
}

/// 2⁻⁵³, half the distance from 1 to the next number of f64.
const U: f64 = f64::EPSILON / 2.0;
/// 1 + 16u, a number of f64.
const GROWN: f64 = 1.0 + 16.0 * U;
/// 2⁻¹⁰⁷⁴: twice what a product or a quotient can lose to underflow.
const LEAST: f64 = f64::from_bits(1);
/// Products from here on are far from underflow: 2⁻⁹⁶⁰.
const NORMAL: f64 = f64::from_bits((1023 - 960) << 52);

impl Bounded {
    fn is_exact(&self) -> bool {
        self.error == 0.0
    }

    /// Whether it is an exact number of at most 26 significant bits, as every f32 is.
    fn is_short(&self) -> bool {
        self.is_exact() && self.value.to_bits() & ((1 << 27) - 1) == 0
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0 && self.is_exact()
    }

    /// None where the divisor may be 0.
    ///
    /// Exact where a product says so. Else, with A = a ± e_a and B = b ± e_b, A/B − a/b = ((A − a) − (a/b)(B − b))/B, and |B| ≥ |b| − e_b.
    pub(super) fn over(self, divisor: Self) -> Option<Self> {
        let least = divisor.value.abs() - divisor.error;
        let value = self.value / divisor.value;
        let product = Self::of(value).times(&divisor);
        if self.is_exact() && product.is_exact() && product.value == self.value && value.is_finite() {
            return Some(Self::of(value));
        }
        let inherited = (self.error + value.abs() * divisor.error) / least;
        let error = (inherited + U * value.abs() + 4.0 * LEAST / least.min(1.0)) * GROWN;
        // Not `least <= 0`, so that what is no number is refused too.
        (least > 0.0 && error.is_finite()).then_some(Self { value, error })
    }

    /// The root of what is above 0 for certain: |√A − √a| = |A − a| / (√A + √a) ≤ e_a / √a.
    pub(super) fn root(self) -> Option<Self> {
        let value = self.value.sqrt();
        let error = (self.error / value + U * value) * GROWN;
        (self.sign() == Some(Ordering::Greater) && error.is_finite()).then_some(Self { value, error })
    }

    pub(super) fn negated(self) -> Self {
        Self { value: -self.value, ..self }
    }

    /// Whether the value is below 0; the truth need not be.
    pub(super) fn seems_negative(&self) -> bool {
        self.value < 0.0
    }

    /// What holds the truth.
    pub(super) fn enclosure(self) -> Enclosure {
        if self.is_exact() {
            return Enclosure { low: self.value, high: self.value };
        }
        Enclosure { low: (self.value - self.error).next_down(), high: (self.value + self.error).next_up() }
    }
}

impl Number for Bounded {
    fn of(number: f64) -> Self {
        Self { value: number, error: 0.0 }
    }

    /// What the sum's rounding lost is known: Knuth's two-sum. So sums that are exact stay so.
    fn plus(&self, other: &Self) -> Self {
        let (a, b) = (self.value, other.value);
        let value = a + b;
        let from_b = value - a;
        let lost = (a - (value - from_b)) + (b - from_b);
        let error = self.error + other.error + lost.abs();
        Self { value, error: if error == 0.0 { 0.0 } else { error * GROWN } }
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// |AB − ab| ≤ |a|·e_b + |b|·e_a + e_a·e_b. Two numbers of 26 bits have a product of 52, which nothing is lost of.
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.value, other.value);
        let value = a * b;
        if self.is_zero() || other.is_zero() {
            return Self::of(0.0);
        }
        if self.is_short() && other.is_short() && value.abs() >= NORMAL {
            return Self { value, error: if value.is_finite() { 0.0 } else { f64::INFINITY } };
        }
        let inherited = a.abs() * other.error + b.abs() * self.error + self.error * other.error;
        Self { value, error: (inherited + U * value.abs() + 4.0 * LEAST) * GROWN }
    }

    fn sign(&self) -> Option<Ordering> {
        if self.is_zero() {
            Some(Ordering::Equal)
        } else if self.value.abs() > self.error {
            self.value.partial_cmp(&0.0)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified::exact::Exact;
    use proptest::prelude::*;

    /// Of any size that coordinates, directions and their products have, some of few bits.
    fn number() -> impl Strategy<Value = f64> {
        let full = (-1.0..1.0_f64, -300..200_i32).prop_map(|(share, power)| share * 2.0_f64.powi(power));
        let short =
            (-64..64_i32, -200..100_i32).prop_map(|(share, power)| f64::from(share) * 2.0_f64.powi(power));
        prop_oneof![3 => full, 2 => short, 1 => (-9..9_i32).prop_map(f64::from)]
    }

    fn holds(bounded: Bounded, exact: &Exact) -> bool {
        let off = exact.minus(&Exact::of(bounded.value));
        [Ordering::Less, Ordering::Equal].contains(&off.compare(&Exact::of(bounded.error)))
            && off.compare(&Exact::of(-bounded.error)) != Ordering::Less
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Chains of operations, each on what the last ones made, with no more error than is claimed.
        #[test]
        fn truth_lies_within_the_bound(numbers in [number(), number(), number(), number()], steps in prop::collection::vec((0..4_u8, 0..8_usize, 0..8_usize), 1..8)) {
            let mut made: Vec<(Bounded, Exact)> = numbers.iter().map(|&number| (Bounded::of(number), Exact::of(number))).collect();
            for (kind, one, other) in steps {
                let (a, b) = (made[one % made.len()].clone(), made[other % made.len()].clone());
                let next = match kind {
                    0 => (a.0.plus(&b.0), a.1.plus(&b.1)),
                    1 => (a.0.minus(&b.0), a.1.minus(&b.1)),
                    2 => (a.0.times(&b.0), a.1.times(&b.1)),
                    _ => match a.0.over(b.0) {
                        Some(quotient) => (quotient, a.1.over(&b.1)),
                        None => continue,
                    },
                };
                prop_assume!(next.0.error.is_finite());
                prop_assert!(holds(next.0, &next.1), "step {kind}: {:?}", next.0);
                if let Some(sign) = next.0.sign() {
                    prop_assert_eq!(Some(sign), next.1.sign());
                }
                if let Some(root) = next.0.root() {
                    let [low, high] = [root.value - root.error, root.value + root.error].map(Exact::of);
                    let squares = [low.times(&low), high.times(&high)];
                    prop_assert!(low.sign() == Some(Ordering::Less) || squares[0].compare(&next.1) != Ordering::Greater);
                    prop_assert!(squares[1].compare(&next.1) != Ordering::Less);
                }
                made.push(next);
            }
        }
    }

    #[test]
    fn what_is_exact_is_known_to_be() {
        let [third, three] = [1.0 / 3.0, 3.0].map(Bounded::of);
        assert!(!third.times(&three).is_exact() && third.times(&three).sign() == Some(Ordering::Greater));
        assert_eq!(three.times(&three).minus(&Bounded::of(9.0)).sign(), Some(Ordering::Equal));
        assert_eq!(Bounded::of(1.0).plus(&Bounded::of(1e-20)).minus(&Bounded::of(1.0)).sign(), None);
    }

    #[test]
    fn what_is_no_number_decides_nothing() {
        let huge = Bounded::of(f64::MAX);
        for lost in [huge.times(&huge), huge.plus(&huge), huge.times(&huge).minus(&huge.times(&huge))] {
            assert_eq!(
                (lost.sign(), lost.over(huge).map(|_| ()), lost.root().map(|_| ())),
                (None, None, None),
                "{lost:?}"
            );
        }
        assert!(Bounded::of(1.0).over(Bounded::of(0.0)).is_none());
    }
}
