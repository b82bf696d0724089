//! The world as seen along a ray.

use crate::lanes::Lanes;

/// The shear that turns the ray's direction into (0, 0, 1).
///
/// Every face that uses a vertex gets the same two coordinates for it, and questions of left or right are asked of these
/// alone, so neighbouring faces never disagree about their common edge: no ray slips between them.
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013. We keep x and y in their cyclic
/// order for directions of either sign, since faces are two-sided here; and there is no second try in double precision,
/// since an edge function that rounds to 0 counts as a hit.
///
/// Coordinates are in the ray's order of axes: the third is the one along which the ray is fastest. All lanes have one
/// order.
#[derive(Clone, Copy)]
pub(crate) struct RaySpace<L> {
    /// Of the ray, in its order of axes.
    pub(crate) origin: [L; 3],
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
    /// A point given in the ray's order of axes.
    #[inline(always)]
    pub(crate) fn see(&self, point: [L; 3]) -> Seen<L> {
        let [x, y, z] = [point[0] - self.origin[0], point[1] - self.origin[1], point[2] - self.origin[2]];
        Seen { x: x - self.shear[0] * z, y: y - self.shear[1] * z, z }
    }
}

/// Twice the signed area of the triangle (foot of the ray, a, b). The two products are rounded before they are
/// subtracted, so the sign is right or the result is 0, and swapping a and b only changes the sign. A fused multiply-add
/// would break that and open cracks.
#[inline(always)]
pub(crate) fn cross<L: Lanes>(a: &Seen<L>, b: &Seen<L>) -> L {
    a.x * b.y - a.y * b.x
}

/// The ray's order of axes: cyclic, the third being that of the largest component of the direction.
#[inline(always)]
pub(crate) fn axes_from(third: usize) -> [usize; 3] {
    [(third + 1) % 3, (third + 2) % 3, third]
}
