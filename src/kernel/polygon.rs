//! A ray against a planar polygon: the crossing-number test (Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994)
//! as seen along the ray.
//!
//! The polygon is projected along the ray rather than along a coordinate axis. Both keep inside and outside, but axis by
//! axis each face rounds its own hit point, and rays aimed at the edge of a closed solid get out between two faces; seen
//! along the ray two faces share the very numbers of their common edge.

#[cfg(doc)]
use super::ray_space::unclear_area;
use super::ray_space::{Seen, cross, crosses};
use super::sphere::Line;
use crate::lanes::{Lanes, Mask, Vector};

/// What is known of a polygon after some of its edges.
#[derive(Clone, Copy)]
pub(crate) struct Outline<L: Lanes> {
    /// Whether the edges so far cross the half-line from the ray's foot an odd number of times.
    pub(crate) odd: L::Mask,
    /// Whether the foot is so near to one of the edges that rounding may have put it on the other side; of a ray that does not
    /// leave a surface, whether the start may lie beside the polygon in its plane, with corners before it and behind.
    pub(crate) unclear: L::Mask,
    /// The smallest and the largest distance of a corner along the ray's third axis.
    pub(crate) least_z: L,
    pub(crate) largest_z: L,
}

impl<L: Lanes> Outline<L> {
    #[inline(always)]
    pub(crate) fn new() -> Self
    where
        L: Lanes<Scalar = f32>,
    {
        Self {
            odd: L::Mask::NONE,
            unclear: L::Mask::NONE,
            least_z: L::splat(f32::INFINITY),
            largest_z: L::splat(f32::NEG_INFINITY),
        }
    }

    /// Takes in an edge.
    #[inline(always)]
    pub(crate) fn add_edge(&mut self, from: &Seen<L>, to: &Seen<L>, zero: L) {
        // Both faces at an edge compute the same but for the sign.
        self.add_turn(from, to, cross(from, to), zero);
    }

    /// Takes in an edge, and asks whether the foot is too near to it: see [`unclear_area`]. What is not among `edges` is no
    /// edge.
    #[inline(always)]
    pub(crate) fn add_edge_with_doubt(
        &mut self,
        from: &Seen<L>,
        to: &Seen<L>,
        (unclear_area, edges): (L, L::Mask),
        zero: L,
    ) {
        let turn = cross(from, to);
        self.add_turn(from, to, turn, zero);
        self.unclear = self.unclear | (edges & turn.abs().le(unclear_area));
    }

    /// Whether some corner is no farther along the ray than t, and whether some corner is.
    #[inline(always)]
    pub(crate) fn sides_of(&self, t: L, t_per_z: L) -> (L::Mask, L::Mask) {
        let (one, other) = (self.least_z * t_per_z, self.largest_z * t_per_z);
        (one.min(other).le(t), one.max(other).gt(t))
    }

    #[inline(always)]
    fn add_turn(&mut self, from: &Seen<L>, to: &Seen<L>, turn: L, zero: L) {
        self.odd = self.odd.xor(crosses(from, to, turn, zero));
        self.least_z = to.z.min(self.least_z);
        self.largest_z = to.z.max(self.largest_z);
    }
}

/// Where a ray meets a plane.
pub(crate) struct Meeting<L: Lanes> {
    pub(crate) t: L,
    /// False where the plane is seen edge-on.
    pub(crate) meets: L::Mask,
    /// Distance of the ray's origin from the plane; of either sign.
    pub(crate) height: L,
    /// n·d.
    pub(crate) slope: L,
}

/// A plane through a point. Seen nearly edge-on it is met anywhere, but no point of the polygon is nearer or farther than
/// all of its corners, so t is kept between theirs.
///
/// With L the distance of the farthest corner from the origin, the height is off by at most 5u·L and t by 10u·L / (|d|·cos θ),
/// by proof; for an origin with a low part 6u and 11u. See docs/accuracy.md.
#[inline(always)]
pub(crate) fn meet_plane<L: Lanes>(
    line: &Line<L>,
    [point, normal]: [Vector<L>; 2],
    corner_ts: [L; 2],
    zero: L,
) -> Meeting<L> {
    let slope = normal.dot(line.direction);
    let height = -normal.dot(line.origin_from(point));
    let [one, other] = corner_ts;
    let (least, largest) = (one.min(other), one.max(other));
    let t = (height / slope).max(least).min(largest);
    Meeting { t, meets: !slope.eq(zero), height, slope }
}
