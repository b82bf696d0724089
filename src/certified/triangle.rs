//! A line and a triangle.
//!
//! With a, b, c the corners as seen from the line's origin and d its direction, the line passes on one side of the edge b c or on the
//! other by the sign of det[d, b, c], and exactly through the edge's own line where that is 0. Inside, all three are of one sign;
//! their sum is d·n, with n = (b − a) × (c − a).

use super::number::{Number, Vector, cross, determinant, dot, minus, vector};
use super::{Bounded, Exact, FaceMeeting, Line, Method, Seen, Surd, by_either, face_meeting};
use glam::{DVec3, Vec3};
use std::cmp::Ordering;

/// Where a line meets a triangle of non-zero area.
#[must_use]
pub fn triangle(line: &Line, corners: [Vec3; 3]) -> FaceMeeting {
    meet(line, &corners.map(Vec3::as_dvec3))
}

pub(super) fn meet(line: &Line, corners: &[DVec3; 3]) -> FaceMeeting {
    let decided = by_either(seen::<Bounded>(line, corners), || seen::<Exact>(line, corners));
    let decided = decided.unwrap_or((Seen::EdgeOn, Method::Fractions));
    let bounds = || {
        let [height, slope] = plane::<Bounded>(line, corners);
        Some(height.over(slope)?.enclosure())
    };
    face_meeting(decided, bounds, || exact_t(line, corners))
}

/// Where a line that is not parallel to it meets the plane.
pub(super) fn exact_t(line: &Line, corners: &[DVec3; 3]) -> Surd {
    let [height, slope] = plane::<Exact>(line, corners);
    Surd::fraction(height.over(&slope))
}

fn seen<N: Number>(line: &Line, corners: &[DVec3; 3]) -> Option<Seen> {
    let [a, b, c] = corners.map(|corner| line.relative::<N>(corner));
    let d = vector(line.direction);
    let signs =
        [determinant(&d, &b, &c), determinant(&d, &c, &a), determinant(&d, &a, &b)].map(|side| side.sign());
    if signs.contains(&Some(Ordering::Less)) && signs.contains(&Some(Ordering::Greater)) {
        // One certain sign each way is enough, unless the sum is 0.
        let [_, slope] = plane::<N>(line, corners);
        return Some(if slope.sign()? == Ordering::Equal { Seen::EdgeOn } else { Seen::Outside });
    }
    let [u, v, w] = signs;
    let is_zero = [u?, v?, w?].map(|sign| sign == Ordering::Equal);
    Some(match is_zero {
        [false, false, false] => Seen::Inside,
        [false, false, true] => Seen::Edge(0),
        [true, false, false] => Seen::Edge(1),
        [false, true, false] => Seen::Edge(2),
        [false, true, true] => Seen::Corner(0),
        [true, false, true] => Seen::Corner(1),
        [true, true, false] => Seen::Corner(2),
        [true, true, true] => Seen::EdgeOn,
    })
}

/// n·(a − o) and n·d: t is the one over the other.
fn plane<N: Number>(line: &Line, corners: &[DVec3; 3]) -> [N; 2] {
    let [a, b, c] = corners.map(vector::<N>);
    let normal: Vector<N> = cross(&minus(&b, &a), &minus(&c, &a));
    [dot(&normal, &line.relative(corners[0])), dot(&normal, &vector(line.direction))]
}
