//! A ray against a planar polygon, projected along a coordinate axis.

use crate::lanes::{Lanes, Mask, Vector};

/// Where a ray meets the plane n·(x − p) = 0: t, and the two coordinates of that place that the projection keeps. Nothing of it
/// is a number where the plane is seen edge-on.
pub(crate) struct Foot<L> {
    pub(crate) t: L,
    pub(crate) kept: [L; 2],
}

/// `line` has the origin's and the direction's components along the two axes that the projection keeps: all but the one along
/// which the normal is largest.
#[inline(always)]
pub(crate) fn meet_plane<L: Lanes>(
    [origin, direction]: [Vector<L>; 2],
    [point, normal]: [Vector<L>; 2],
    line: [[L; 2]; 2],
) -> Foot<L> {
    let t = normal.dot(point - origin) / normal.dot(direction);
    let [from, along] = line;
    Foot { t, kept: [from[0] + along[0] * t, from[1] + along[1] * t] }
}

/// Whether an edge, in the two coordinates that are kept, crosses the half-line from the foot; the foot is inside where an odd
/// number of edges does.
///
/// Each face rounds a foot of its own, so two that share an edge may both take it for the other's. Source: Haines, "Point in
/// Polygon Strategies", Graphics Gems IV, 1994, the crossings test with its division multiplied out.
#[inline(always)]
pub(crate) fn crosses<L: Lanes>(foot: [L; 2], from: [L; 2], to: [L; 2]) -> L::Mask {
    let [u, v] = foot;
    let (from_above, to_above) = (from[1].ge(v), to[1].ge(v));
    let is_right = ((to[1] - v) * (from[0] - to[0])).ge((to[0] - u) * (from[1] - to[1]));
    from_above.xor(to_above) & !is_right.xor(to_above)
}
