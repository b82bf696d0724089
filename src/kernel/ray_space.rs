//! The world as seen along a ray.

use super::UNIT_ROUNDOFF;
use crate::lanes::Lanes;

/// The shear that turns the ray's direction into (0, 0, 1).
///
/// Every face that uses a vertex gets the same two coordinates for it, and questions of left or right are asked of these
/// alone, so neighbouring faces never disagree about their common edge: no ray slips between them.
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013. We keep x and y in their cyclic
/// order for directions of either sign, since faces are two-sided here; and there is no second try in double precision for
/// an edge function that rounds to 0, since [`crosses`] decides for both faces at the edge alike.
///
/// Coordinates are in the ray's order of axes: the third is the one along which the ray is fastest. All lanes have one
/// order.
#[derive(Clone, Copy)]
pub(crate) struct RaySpace<L> {
    /// Of the ray, in its order of axes.
    pub(crate) origin: [L; 3],
    /// What the origin's rounding to f32 left out; none where that is nothing, as of rays from the eye.
    pub(crate) origin_low: Option<[L; 3]>,
    /// d_x / d_z and d_y / d_z, each as a product with 1 / d_z.
    pub(crate) shear: [L; 2],
    /// 1 / d_z: turns a distance along the third axis into t.
    pub(crate) t_per_z: L,
}

/// A point in ray space: x and y sheared, z only moved.
#[derive(Clone, Copy)]
pub(crate) struct Seen<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl<L: Lanes> RaySpace<L> {
    /// A point given in the ray's order of axes. Its x and y are off by at most 3u·|x| + 7u·|z|, and 3u·|y| + 7u·|z|: two
    /// roundings of each difference, two of the shear, one of the product and one of the last difference.
    #[inline(always)]
    pub(crate) fn see(&self, point: [L; 3]) -> Seen<L> {
        let [x, y, z] = [point[0] - self.origin[0], point[1] - self.origin[1], point[2] - self.origin[2]];
        let [x, y, z] = match self.origin_low {
            Some(low) => [x - low[0], y - low[1], z - low[2]],
            None => [x, y, z],
        };
        Seen { x: x - self.shear[0] * z, y: y - self.shear[1] * z, z }
    }
}

/// How large the area may be that an edge spans with the ray's foot where rounding may have put the foot on the other side of
/// the edge. `size` is the longest distance s between two corners of the face, `longest_edge` the length ℓ of its longest
/// edge, `corner` any corner.
///
/// Seen along the ray, corners are no more than √2·s apart on either axis, and edges no longer than √3·ℓ. Where the foot is
/// inside, or so near to it that rounding counts, no corner is farther from it than that, and none deeper than |z| + s, z the
/// depth of the given one. So a corner is off by at most e = u·(11.3s + 7|z|) a coordinate, see [`RaySpace::see`]. What is
/// decided is right for corners that are moved by that, so in truth as well unless the foot is within √2·e of the edge. Its
/// area is that times the edge's length at most, √6·e·ℓ = u·(28s + 17.2|z|)·ℓ, and the rounding of the area itself is below 5u·s².
#[inline(always)]
pub(crate) fn unclear_area<L: Lanes<Scalar = f32>>(corner: &Seen<L>, [size, longest_edge]: [L; 2]) -> L {
    let off = L::splat(20.0 * UNIT_ROUNDOFF) * longest_edge * (corner.z.abs() + size + size);
    off + L::splat(5.0 * UNIT_ROUNDOFF) * (size * size)
}

/// Whether an edge crosses the half-line from the ray's foot along x: seen from a closed outline, the foot is inside where
/// the edges do so an odd number of times. Half open: a corner level with the foot counts as above it and an edge through it
/// as left of it, for every face alike. So exactly one of two faces at an edge holds what falls on it.
#[inline(always)]
pub(crate) fn crosses<L: Lanes>(from: &Seen<L>, to: &Seen<L>, turn: L, zero: L) -> L::Mask {
    let (from_below, to_below) = (from.y.lt(zero), to.y.lt(zero));
    let upward = from_below & !to_below & turn.gt(zero);
    let downward = !from_below & to_below & turn.lt(zero);
    upward | downward
}

/// Twice the signed area of the triangle (foot of the ray, a, b). The two products are rounded before they are
/// subtracted, so the sign is right or the result is 0, and swapping a and b only changes the sign. A fused multiply-add
/// would break that and open cracks.
#[inline(always)]
pub(crate) fn cross<L: Lanes>(a: &Seen<L>, b: &Seen<L>) -> L {
    a.x * b.y - a.y * b.x
}

/// The order of axes of a ray of this direction; of components that are equally large the first counts.
#[inline(always)]
pub(crate) fn axes_along(direction: [f32; 3]) -> [usize; 3] {
    let sizes = direction.map(f32::abs);
    axes_from(if sizes[0] >= sizes[1] && sizes[0] >= sizes[2] {
        0
    } else if sizes[1] >= sizes[2] {
        1
    } else {
        2
    })
}

/// The ray's order of axes: cyclic, the third being that of the largest component of the direction.
#[inline(always)]
pub(crate) fn axes_from(third: usize) -> [usize; 3] {
    [(third + 1) % 3, (third + 2) % 3, third]
}
