//! A ray against an axis-aligned box: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986.

use super::UNIT_ROUNDOFF;
use crate::lanes::{Lanes, Vector};

/// What the slab test needs of a ray.
///
/// The test has to let through whatever a primitive's own test may hit, so the box is grown: its near planes are measured
/// from an origin that is farther along the ray, its far planes from one that is less far. That takes registers and no
/// arithmetic.
#[derive(Clone, Copy)]
pub(crate) struct Slabs<L> {
    pub(crate) near_origin: Vector<L>,
    pub(crate) far_origin: Vector<L>,
    /// 1 / direction, all of it finite.
    pub(crate) inverse: Vector<L>,
}

/// By how much boxes are grown, as a share of the largest coordinate of the scene and of the origin.
///
/// Of these 16u, u = 2⁻²⁴, the test's own rounding may take 4u: one of the padded origin, and three of a plane's t. What is left,
/// 12u, is more than the 10u within which a ray passes a primitive that its kernel finds it to hit, by proof: docs/accuracy.md.
pub(crate) const PADDING: f32 = 16.0 * UNIT_ROUNDOFF;

/// A component of the direction that is smaller than this share of the largest is taken as this share: 1/d stays finite,
/// 0 · ∞ does not arise, and the ray is moved by less than the padding.
pub(crate) const LEAST_COMPONENT: f32 = 1.0 / (1_u64 << 60) as f32;

/// Where rays enter boxes, not below 0, and whether they are inside before `t_max`. `near` and `far` are the planes that
/// the ray meets first and last: low and high where its component is positive, high and low where it is negative.
///
/// A ray that passes the box by 11.9u of the coordinates or less on each axis is let through, one that passes it by 20.1u is not.
#[inline(always)]
pub(crate) fn enter<L: Lanes>(
    slabs: &Slabs<L>,
    near: Vector<L>,
    far: Vector<L>,
    zero: L,
    t_max: L,
) -> (L, L::Mask) {
    let to_near = (near - slabs.near_origin).times(slabs.inverse);
    let to_far = (far - slabs.far_origin).times(slabs.inverse);
    let enter = to_near.x.max(to_near.y).max(to_near.z.max(zero));
    let leave = to_far.x.min(to_far.y).min(to_far.z.min(t_max));
    (enter, enter.le(leave))
}
