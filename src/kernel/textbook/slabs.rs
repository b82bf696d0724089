//! A ray against a box by a slab test with its products multiplied out.

use crate::lanes::{Lanes, Vector};

/// What the test needs of a ray.
#[derive(Clone, Copy)]
pub(crate) struct Multiplied<L> {
    /// o / d, axis by axis.
    pub(crate) origin_by_direction: Vector<L>,
    /// 1 / d, all of it finite.
    pub(crate) inverse: Vector<L>,
}

/// The slab test with (b − o)/d taken as b·(1/d) − o·(1/d), so that an axis takes a product and a difference, or one fused
/// operation; otherwise [`bounds::enter`](crate::kernel::bounds::enter).
///
/// Far from the origin of the world both products are large and their difference is not: its error is not bounded by any share
/// of it. Embree's fast mode has this form (kernels/bvh/node_intersector1.h).
#[inline(always)]
pub(crate) fn enter<L: Lanes>(
    ray: &Multiplied<L>,
    near: Vector<L>,
    far: Vector<L>,
    zero: L,
    t_max: L,
) -> (L, L::Mask) {
    let to_near = near.times(ray.inverse) - ray.origin_by_direction;
    let to_far = far.times(ray.inverse) - ray.origin_by_direction;
    let enter = to_near.x.max(to_near.y).max(to_near.z.max(zero));
    let leave = to_far.x.min(to_far.y).min(to_far.z.min(t_max));
    (enter, enter.le(leave))
}
