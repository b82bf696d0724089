//! The judge of hits: it says with certainty what a ray meets.
//!
//! The reference is a textbook's formulas in f64; near an edge, a limb or a second surface its answer is as uncertain as any, only
//! in a smaller band. The judge has no such band. A scene's numbers are taken as they are, as f32, and so is the ray; from them
//!
//! 1. every formula is worked out in f64 with a proven bound of its error (`bounded`), which decides nearly always;
//! 2. where it does not, the same formula is worked out again in fractions (`exact`), which always decide.
//!
//! So there is no tolerance in what it says. It shares no arithmetic with `kernel`, `traverse` or `reference`: it asks for signs of
//! determinants in the world's own axes, without a shear or a quotient.
//!
//! - [`triangle()`], [`polygon()`], [`sphere()`], [`axis_box()`]: one line and one primitive
//! - [`Judge`]: a ray and a scene, every primitive tried; what is met first, what is in the way
//! - [`Judge::judge_closest`], [`Judge::judge_occluded`]: an engine's answer, judged: right, right within rounding, or wrong, and how
//!   far from right
//!
//! It is slow, and for tests: about a microsecond for each primitive, some ten where fractions are needed.

mod axis_box;
mod bounded;
mod exact;
mod number;
mod polygon;
mod rounding;
mod scene;
mod sphere;
#[cfg(test)]
mod tests;
mod triangle;
mod verdict;

pub use axis_box::{BoxMeeting, axis_box};
pub use polygon::{plane_t, polygon};
pub use scene::{Closest, Crossing, Judge, Occlusion, Place};
pub use sphere::{Limb, Side, SphereMeeting, sphere};
pub use triangle::triangle;
pub use verdict::{Answer, BAND, Judgement, Verdict};

use bounded::Bounded;
use exact::{Exact, Surd};
use glam::DVec3;
use number::{Number, Vector, vector};

/// A ray's line: origin + t·direction. World space; both finite, the direction of any length but 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where t is 0.
    pub origin: DVec3,
    /// What a t of 1 adds.
    pub direction: DVec3,
}

/// low ≤ truth ≤ high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// Not above the truth.
    pub low: f64,
    /// Not below it.
    pub high: f64,
}

/// Where a line passes an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// Strictly inside.
    Inside,
    /// Exactly through an edge, between its ends: that from the corner of this index to the next.
    Edge(usize),
    /// Exactly through a corner.
    Corner(usize),
    /// Past it.
    Outside,
    /// The plane is parallel to the line: it is met nowhere, or everywhere.
    EdgeOn,
}

/// A line and a triangle or a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceMeeting {
    /// Where the line passes the outline.
    pub seen: Seen,
    /// Where it meets the plane; none where the outline is missed or seen edge-on.
    pub t: Option<Enclosure>,
    /// What it took.
    pub by: Method,
}

/// What it took to be certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// f64 and a bound of its error.
    Bounds,
    /// Fractions.
    Fractions,
}

impl Enclosure {
    /// high − low, rounded up.
    #[must_use]
    pub fn width(&self) -> f64 {
        if self.low == self.high { 0.0 } else { (self.high - self.low).next_up() }
    }

    /// How far a number is from the nearest that the truth may be.
    #[must_use]
    pub fn distance(&self, number: f64) -> f64 {
        (self.low - number).max(number - self.high).max(0.0)
    }

    /// The truth may be this number.
    #[must_use]
    pub fn contains(&self, number: f64) -> bool {
        self.low <= number && number <= self.high
    }

    /// Half way.
    #[must_use]
    pub fn middle(&self) -> f64 {
        self.low + (self.high - self.low) / 2.0
    }

    /// Wide beside the rounding of f64, as where digits were lost: 2⁻⁴⁰ of itself.
    fn is_wide(&self) -> bool {
        self.width() > self.low.abs().max(self.high.abs()) / (1_u64 << 40) as f64
    }
}

impl Seen {
    /// Exactly on the outline, where either answer is right for one face.
    #[must_use]
    pub fn is_boundary(self) -> bool {
        matches!(self, Self::Edge(_) | Self::Corner(_))
    }

    fn is_met(self) -> bool {
        self == Self::Inside || self.is_boundary()
    }
}

impl Line {
    /// Of a ray's own numbers.
    #[must_use]
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        let [origin, direction] = [origin, direction].map(|vector| DVec3::from(vector.map(f64::from)));
        Self { origin, direction }
    }

    /// A point of a face as seen from the origin.
    fn relative<N: Number>(&self, point: DVec3) -> Vector<N> {
        number::minus(&vector(point), &vector(self.origin))
    }
}

/// By bounds where they decide, else by fractions.
fn by_either<T>(bounds: Option<T>, fractions: impl FnOnce() -> Option<T>) -> Option<(T, Method)> {
    match bounds {
        Some(decided) => Some((decided, Method::Bounds)),
        None => Some((fractions()?, Method::Fractions)),
    }
}

/// An outline and t by either way, put together.
fn face_meeting(
    seen: (Seen, Method),
    bounds: impl FnOnce() -> Option<Enclosure>,
    fractions: impl FnOnce() -> Surd,
) -> FaceMeeting {
    let (seen, by) = seen;
    if !seen.is_met() {
        return FaceMeeting { seen, t: None, by };
    }
    match bounds().filter(|t| !t.is_wide()) {
        Some(t) => FaceMeeting { seen, t: Some(t), by },
        None => FaceMeeting { seen, t: Some(fractions().enclosure()), by: Method::Fractions },
    }
}
