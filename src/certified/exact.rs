//! Numbers without rounding: fractions, and what a square root makes of them.
//!
//! Fractions are dashu's, in the variant that takes out common factors of 2 and looks for no others: all that a scene and a
//! ray hold are fractions with a power of two below, and sums and products stay so.

use super::Enclosure;
use super::number::Number;
use dashu_ratio::Relaxed;
use std::cmp::Ordering;

/// A fraction.
#[derive(Clone, Debug)]
pub(super) struct Exact(Relaxed);

impl Exact {
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        self.0.cmp(&other.0)
    }

    /// By what is not 0.
    pub(super) fn over(&self, divisor: &Self) -> Self {
        Self(&self.0 / &divisor.0)
    }

    fn ordering(&self) -> Ordering {
        self.0.cmp(&Relaxed::ZERO)
    }

    /// Some number of f64 near it.
    fn rough(&self) -> f64 {
        self.0.to_f64_fast()
    }

    fn squared(&self) -> Self {
        self.times(self)
    }
}

impl Number for Exact {
    fn of(number: f64) -> Self {
        debug_assert!(number.is_finite(), "{number} is no fraction");
        Self(Relaxed::try_from(number).unwrap_or(Relaxed::ZERO))
    }

    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 + &other.0)
    }

    fn minus(&self, other: &Self) -> Self {
        Self(&self.0 - &other.0)
    }

    fn times(&self, other: &Self) -> Self {
        Self(&self.0 * &other.0)
    }

    fn sign(&self) -> Option<Ordering> {
        Some(self.ordering())
    }
}

/// a + b·√d, with d ≥ 0: every t at which a line meets a face or a sphere.
#[derive(Clone, Debug)]
pub(super) struct Surd {
    a: Exact,
    b: Exact,
    d: Exact,
}

impl Surd {
    pub(super) fn new(a: Exact, b: Exact, d: Exact) -> Self {
        Self { a, b, d }
    }

    /// Without a root.
    pub(super) fn fraction(a: Exact) -> Self {
        Self { a, b: Exact::of(0.0), d: Exact::of(0.0) }
    }

    pub(super) fn sign(&self) -> Ordering {
        let (a, b) = (self.a.ordering(), self.b.ordering().min_by_zero(self.d.ordering()));
        larger(a, b, || self.a.squared().compare(&self.b.squared().times(&self.d)))
    }

    /// a − a' + b·√d − b'·√d': the sign of the first three terms, and of the fourth; where these differ, their squares decide,
    /// whose difference has one root again.
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        let a = self.a.minus(&other.a);
        let first = Self { a: a.clone(), b: self.b.clone(), d: self.d.clone() };
        let second = other.b.ordering().min_by_zero(other.d.ordering()).reverse();
        larger(first.sign(), second, || {
            let squares = a.squared().plus(&self.b.squared().times(&self.d));
            let rest = squares.minus(&other.b.squared().times(&other.d));
            let twice = Exact::of(2.0).times(&a).times(&self.b);
            Self { a: rest, b: twice, d: self.d.clone() }.sign()
        })
    }

    pub(super) fn compare_f64(&self, number: f64) -> Ordering {
        if number.is_infinite() {
            return 0.0.partial_cmp(&number).unwrap_or(Ordering::Equal);
        }
        self.compare(&Self::fraction(Exact::of(number)))
    }

    /// The two numbers of f64 next to it, or it twice where it is one. What is rough is only where the search begins: each end is
    /// compared exactly.
    pub(super) fn enclosure(&self) -> Enclosure {
        let guess = self.a.rough() + self.b.rough() * self.d.rough().sqrt();
        let guess = if guess.is_nan() { 0.0 } else { guess };
        let is_at_most = |place: i64| self.compare_f64(at(place)) != Ordering::Less;
        // low ≤ this < high, first any two such places, then neighbours.
        let (mut low, mut high, mut step) = (place_of(guess), place_of(guess), 1);
        while !is_at_most(low) {
            (low, high) = (low.saturating_sub(step).max(place_of(f64::NEG_INFINITY)), low);
            step = step.saturating_mul(2);
        }
        step = 1;
        while is_at_most(high) {
            (low, high) = (high, high.saturating_add(step).min(place_of(f64::INFINITY)));
            step = step.saturating_mul(2);
        }
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *(if is_at_most(middle) { &mut low } else { &mut high }) = middle;
        }
        if self.compare_f64(at(low)) == Ordering::Equal {
            high = low;
        }
        Enclosure { low: at(low), high: at(high) }
    }
}

/// The sign of x + y by the signs of x and y, and where they differ by how x² compares with y².
fn larger(x: Ordering, y: Ordering, squares: impl FnOnce() -> Ordering) -> Ordering {
    if x == y || y == Ordering::Equal {
        return x;
    }
    if x == Ordering::Equal {
        return y;
    }
    match squares() {
        Ordering::Greater => x,
        Ordering::Equal => Ordering::Equal,
        Ordering::Less => y,
    }
}

trait Sign {
    /// The sign of a product with a root: 0 where that is 0.
    fn min_by_zero(self, root: Ordering) -> Self;
}

impl Sign for Ordering {
    fn min_by_zero(self, root: Ordering) -> Self {
        if root == Self::Equal { root } else { self }
    }
}

/// Numbers of f64 in their order, counted from 0: neighbours differ by 1.
fn place_of(number: f64) -> i64 {
    let size = (number.to_bits() & !(1 << 63)).cast_signed();
    if number.is_sign_negative() { -size } else { size }
}

fn at(place: i64) -> f64 {
    let size = f64::from_bits(place.unsigned_abs());
    if place < 0 { -size } else { size }
}
