//! A line and a sphere.
//!
//! |o + t·d − c|² = r² is a·t² + 2b·t + e = 0 with a = d·d, b = (o − c)·d, e = |o − c|² − r². The line meets the sphere by the sign of
//! D = b² − a·e, which is r²·a − |(o − c) × d|² by Lagrange's identity and loses less so; it is 0 for a tangent.

use super::number::{Number, Vector, cross, dot, minus, vector};
use super::{Bounded, Enclosure, Exact, Line, Method, Surd, by_either};
use glam::{DVec3, Vec3};
use std::cmp::Ordering;

/// Whether a line meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limb {
    /// Nowhere.
    Missed,
    /// In one point, exactly.
    Touched,
    /// In two.
    Crossed,
}

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Nearer to the centre than the radius.
    Inside,
    /// On the surface, exactly.
    On,
    /// Farther.
    Outside,
}

/// A line and a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereMeeting {
    /// Whether it is met.
    pub limb: Limb,
    /// Where the line enters and where it leaves; the same twice for a tangent, none for a miss.
    pub roots: Option<[Enclosure; 2]>,
    /// Where the line's origin is.
    pub origin: Side,
    /// What it took.
    pub by: Method,
}

/// Where a line meets a sphere.
#[must_use]
pub fn sphere(line: &Line, center: Vec3, radius: f32) -> SphereMeeting {
    meet(line, &(center.as_dvec3(), f64::from(radius)))
}

/// Centre and radius.
pub(super) type Ball = (DVec3, f64);

pub(super) fn meet(line: &Line, ball: &Ball) -> SphereMeeting {
    let quadratic = Quadratic::<Bounded>::new(line, ball);
    let signs = |found: [Option<Ordering>; 2]| Some([found[0]?, found[1]?]);
    let fractions = || {
        let exact = Quadratic::<Exact>::new(line, ball);
        signs([exact.discriminant.sign(), exact.e.sign()])
    };
    let decided = by_either(signs([quadratic.discriminant.sign(), quadratic.e.sign()]), fractions);
    let ([discriminant, e], mut by) = decided.unwrap_or(([Ordering::Less; 2], Method::Fractions));
    let limb = match discriminant {
        Ordering::Less => Limb::Missed,
        Ordering::Equal => Limb::Touched,
        Ordering::Greater => Limb::Crossed,
    };
    let origin = match e {
        Ordering::Less => Side::Inside,
        Ordering::Equal => Side::On,
        Ordering::Greater => Side::Outside,
    };
    let roots = (limb != Limb::Missed).then(|| {
        let bounded = quadratic.roots().map(|roots| roots.map(Bounded::enclosure));
        bounded.filter(|roots| !roots.iter().any(Enclosure::is_wide)).unwrap_or_else(|| {
            by = Method::Fractions;
            exact_roots(line, ball).map(|root| root.enclosure())
        })
    });
    SphereMeeting { limb, roots, origin, by }
}

/// Where a line that meets it enters and leaves.
pub(super) fn exact_roots(line: &Line, ball: &Ball) -> [Surd; 2] {
    let Quadratic { a, b, discriminant, .. } = Quadratic::<Exact>::new(line, ball);
    let middle = Exact::of(0.0).minus(&b).over(&a);
    [-1.0, 1.0].map(|side| Surd::new(middle.clone(), Exact::of(side).over(&a), discriminant.clone()))
}

/// Where a line that begins on the surface meets the far side: with e = 0 the roots are 0 and −2b/a. The origin is known to be on
/// the surface, whatever its rounding says.
pub(super) fn exact_far_side(line: &Line, ball: &Ball) -> Surd {
    let Quadratic { a, b, .. } = Quadratic::<Exact>::new(line, ball);
    Surd::fraction(Exact::of(-2.0).times(&b).over(&a))
}

struct Quadratic<N> {
    a: N,
    b: N,
    e: N,
    discriminant: N,
}

impl<N: Number> Quadratic<N> {
    fn new(line: &Line, (center, radius): &Ball) -> Self {
        let from_center: Vector<N> = minus(&vector(line.origin), &vector(*center));
        let d = vector(line.direction);
        let a = dot(&d, &d);
        let radius = N::of(*radius);
        let radius_squared = radius.times(&radius);
        let aside = cross(&from_center, &d);
        Self {
            b: dot(&from_center, &d),
            e: dot(&from_center, &from_center).minus(&radius_squared),
            discriminant: radius_squared.times(&a).minus(&dot(&aside, &aside)),
            a,
        }
    }
}

impl Quadratic<Bounded> {
    /// The root of larger magnitude by the sum that loses nothing, the other by their product e/a. Which is larger is a matter of
    /// precision alone: both formulas hold either way.
    fn roots(&self) -> Option<[Bounded; 2]> {
        let root = self.discriminant.root()?;
        if self.b.seems_negative() {
            let sum = root.minus(&self.b);
            Some([self.e.over(sum)?, sum.over(self.a)?])
        } else {
            let sum = root.plus(&self.b).negated();
            Some([sum.over(self.a)?, self.e.over(sum)?])
        }
    }
}
