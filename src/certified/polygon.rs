//! A line and a polygon, planar or bent: the outline as seen along the line, by the even-odd rule.
//!
//! Corners seen from the line's origin are taken along the direction d into the plane in which d is fastest, times d_z, which
//! spares the quotient: X = x·d_z − d_x·z, Y = y·d_z − d_y·z. An edge from p to q then turns round the line by the sign of
//! det[d, p, q]·d_z, and the line passes exactly through it where that is 0 and it lies between the ends. What is neither on an edge
//! nor at a corner is inside where a half-line from it along Y = 0 crosses the outline an odd number of times; which of the two, that
//! of X > 0 or of X < 0, changes nothing, so the sign of d_z is left out.
//!
//! t is that of the plane through the first corner with Newell's normal, no nearer and no farther than the corners are, which is the
//! contract for polygons whose corners are not quite in a plane; of a planar one it changes nothing.

use super::number::{Number, Vector, cross, determinant, dot, minor, minus, plus, vector};
use super::{Bounded, Enclosure, Exact, FaceMeeting, Line, Method, Seen, Surd, by_either, face_meeting};
use glam::{DVec3, Vec3};
use std::cmp::Ordering;

/// Where a line meets a polygon of three or more corners.
#[must_use]
pub fn polygon(line: &Line, corners: &[Vec3]) -> FaceMeeting {
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    meet(line, &corners)
}

/// Where a line meets the plane of a polygon or a triangle, kept between its corners, wherever it passes the outline; none where it is
/// parallel to the plane.
#[must_use]
pub fn plane_t(line: &Line, corners: &[Vec3]) -> Option<Enclosure> {
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let [_, slope] = plane::<Exact>(line, &corners);
    if slope.sign() == Some(Ordering::Equal) {
        return None;
    }
    let bounded = bounded_t(line, &corners).filter(|t| !t.is_wide());
    Some(bounded.unwrap_or_else(|| exact_t(line, &corners).enclosure()))
}

pub(super) fn meet(line: &Line, corners: &[DVec3]) -> FaceMeeting {
    let decided = by_either(seen::<Bounded>(line, corners), || seen::<Exact>(line, corners));
    let decided = decided.unwrap_or((Seen::EdgeOn, Method::Fractions));
    face_meeting(decided, || bounded_t(line, corners), || exact_t(line, corners))
}

/// Where a line that is not parallel to it meets it.
pub(super) fn exact_t(line: &Line, corners: &[DVec3]) -> Surd {
    let [height, slope] = plane::<Exact>(line, corners);
    let mut t = height.over(&slope);
    let speed = Exact::of(line.direction[fastest(line)]);
    let ts: Vec<Exact> = corners.iter().map(|&corner| along::<Exact>(line, corner).over(&speed)).collect();
    // Kept below the farthest corner first; either order is right, since the nearest is not beyond it.
    for keep in [Ordering::Less, Ordering::Greater] {
        let end = ts.iter().reduce(|end, t| if t.compare(end) == keep.reverse() { t } else { end });
        if let Some(end) = end
            && t.compare(end) == keep.reverse()
        {
            t = end.clone();
        }
    }
    Surd::fraction(t)
}

fn bounded_t(line: &Line, corners: &[DVec3]) -> Option<Enclosure> {
    let [height, slope] = plane::<Bounded>(line, corners);
    let t = height.over(slope)?.enclosure();
    let speed = Bounded::of(line.direction[fastest(line)]);
    let (mut near, mut far) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &corner in corners {
        let Enclosure { low, high } = along::<Bounded>(line, corner).over(speed)?.enclosure();
        near = [near[0].min(low), near[1].min(high)];
        far = [far[0].max(low), far[1].max(high)];
    }
    // What is kept between grows with each of the three.
    Some(Enclosure { low: t.low.min(far[0]).max(near[0]), high: t.high.min(far[1]).max(near[1]) })
}

fn seen<N: Number>(line: &Line, corners: &[DVec3]) -> Option<Seen> {
    let [_, slope] = plane::<N>(line, corners);
    if slope.sign()? == Ordering::Equal {
        return Some(Seen::EdgeOn);
    }
    let d: Vector<N> = vector(line.direction);
    let corners: Vec<Corner<N>> = corners.iter().map(|&corner| Corner::new(line, &d, corner)).collect();
    let mut inside = false;
    for (index, from) in corners.iter().enumerate() {
        let to = &corners[(index + 1) % corners.len()];
        if from.y.is_some() && from.y == to.y && from.y != Some(Ordering::Equal) {
            continue; // Above the half-line, or below it.
        }
        let turn = determinant(&d, &from.place, &to.place).sign()?;
        let [from_y, to_y] = [from.y?, to.y?];
        if turn == Ordering::Equal {
            let [from_x, to_x] = [from.x?, to.x?];
            match [from, to].map(|end| end.x == Some(Ordering::Equal) && end.y == Some(Ordering::Equal)) {
                [true, _] => return Some(Seen::Corner(index)),
                [_, true] => return Some(Seen::Corner((index + 1) % corners.len())),
                _ if from_x == to_x && from_y == to_y => {} // Both ends on one side of the line.
                _ => return Some(Seen::Edge(index)),
            }
        }
        let [from_below, to_below] = [from_y, to_y].map(|y| y == Ordering::Less);
        inside ^= from_below && !to_below && turn == Ordering::Greater;
        inside ^= !from_below && to_below && turn == Ordering::Less;
    }
    Some(if inside { Seen::Inside } else { Seen::Outside })
}

/// A corner from the line's origin, and the signs of its X and Y.
struct Corner<N> {
    place: Vector<N>,
    x: Option<Ordering>,
    y: Option<Ordering>,
}

impl<N: Number> Corner<N> {
    fn new(line: &Line, d: &Vector<N>, corner: DVec3) -> Self {
        let place = line.relative::<N>(corner);
        let z = fastest(line);
        let [x, y] = [(z + 1) % 3, (z + 2) % 3].map(|axis| minor(&place, d, [axis, z]).sign());
        Self { place, x, y }
    }
}

/// n·(p_0 − o) and n·d with Newell's n = Σ (p_k − p_0) × (p_k+1 − p_0).
fn plane<N: Number>(line: &Line, corners: &[DVec3]) -> [N; 2] {
    let first: Vector<N> = vector(corners[0]);
    let from_first = |corner: DVec3| minus(&vector(corner), &first);
    let spanned = corners.windows(2).map(|edge| cross(&from_first(edge[0]), &from_first(edge[1])));
    let normal = spanned.fold(vector(DVec3::ZERO), |sum, part| plus(&sum, &part));
    [dot(&normal, &line.relative(corners[0])), dot(&normal, &vector(line.direction))]
}

/// The axis along which the line is fastest, of equal ones the first.
fn fastest(line: &Line) -> usize {
    let size = line.direction.abs();
    (1..3).fold(0, |fastest, axis| if size[axis] > size[fastest] { axis } else { fastest })
}

fn along<N: Number>(line: &Line, corner: DVec3) -> N {
    let axis = fastest(line);
    N::of(corner[axis]).minus(&N::of(line.origin[axis]))
}
