//! Bounds of what several rays see: where corners lie from the foot of any of them.
//!
//! What rays compute of a corner is computed from the bounds of their numbers instead. Rounding is monotonic, so what each ray
//! computes for itself lies within, to the bit: a primitive that the bounds say is missed is missed by every ray's own test.
//! Source: Reshetov, "Faster Ray Packets – Triangle Intersection through Vertex Culling", 2007, who asks planes of the packet's
//! frustum.

use crate::kernel::{RaySpace, UNIT_ROUNDOFF};
use crate::lanes::{Lanes, RECORD, Single, least_of_each};

/// The least and the largest of a number over some rays.
pub(super) type Bounds = [f32; 2];

/// Of the numbers of some rays that have one order of axes, in that order. See [`RaySpace`].
#[derive(Clone, Copy, Default)]
pub(super) struct Sight {
    pub(super) origin: [Bounds; 3],
    /// Where rays start on primitives.
    pub(super) origin_low: Option<[Bounds; 3]>,
    pub(super) shear: [Bounds; 2],
}

/// Where a corner lies, for any of the rays: the least and the largest.
#[derive(Clone, Copy)]
pub(super) struct SeenBounds<L> {
    pub(super) x: [L; 2],
    pub(super) y: [L; 2],
    pub(super) z: [L; 2],
}

impl Sight {
    /// That of the rays of a mask.
    #[inline(always)]
    pub(super) fn of<F: Single>(space: &RaySpace<F>, mask: F::Mask) -> Self {
        let none = F::splat(f32::INFINITY);
        let bounds_of = |[a, b, c]: [F; 3]| {
            let lanes: [F; RECORD] = [a, -a, b, -b, c, -c, none, none];
            let [a, minus_a, b, minus_b, c, minus_c, ..] =
                least_of_each(lanes.map(|lanes| F::select(mask, lanes, none)));
            [[a, -minus_a], [b, -minus_b], [c, -minus_c]]
        };
        let [x, y] = space.shear;
        let [x, y, _] = bounds_of([x, y, y]);
        Self { origin: bounds_of(space.origin), origin_low: space.origin_low.map(bounds_of), shear: [x, y] }
    }

    /// What [`RaySpace::see`] says of points in lanes.
    #[inline(always)]
    pub(super) fn see<L: Lanes<Scalar = f32>>(&self, [x, y, z]: [L; 3]) -> SeenBounds<L> {
        let from = |[least, largest]: [L; 2], origin: Bounds| {
            [least - L::splat(origin[1]), largest - L::splat(origin[0])]
        };
        let moved = |point: L, axis: usize| {
            let moved = from([point, point], self.origin[axis]);
            self.origin_low.map_or(moved, |low| from(moved, low[axis]))
        };
        let z = moved(z, 2);
        let sheared = |[least, largest]: [L; 2], shear: Bounds| {
            let [one, other] = shear.map(L::splat);
            let [a, b, c, d] = [one * z[0], one * z[1], other * z[0], other * z[1]];
            [least - a.max(b).max(c.max(d)), largest - a.min(b).min(c.min(d))]
        };
        SeenBounds { x: sheared(moved(x, 0), self.shear[0]), y: sheared(moved(y, 1), self.shear[1]), z }
    }
}

impl<L: Lanes<Scalar = f32>> SeenBounds<L> {
    /// How far from where it is taken to be a corner may be: several times what `unclear_area` allows for. `size` is the
    /// longest distance between corners.
    #[inline(always)]
    pub(super) fn doubt(&self, size: L) -> L {
        let deepest = self.z[0].abs().max(self.z[1].abs());
        L::splat(64.0 * UNIT_ROUNDOFF) * (deepest + size + size)
    }
}
