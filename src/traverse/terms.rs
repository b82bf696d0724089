//! What the tests need of a ray beside its origin and direction, computed in one place: rays of streams and rays alone get the
//! same bits.

use crate::kernel::axes_from;
use crate::kernel::bounds::{LEAST_COMPONENT, PADDING};
use crate::lanes::Lanes;

/// Of rays whose directions have the same signs and the same fastest axis.
pub(super) struct Terms<L> {
    /// By how much boxes are grown.
    pub(super) padding: L,
    /// 1 / direction, all of it finite.
    pub(super) inverse: [L; 3],
    pub(super) shear: [L; 2],
    /// t for each unit along the fastest axis.
    pub(super) t_per_z: L,
    /// d·d.
    pub(super) a: L,
}

impl<L: Lanes<Scalar = f32>> Terms<L> {
    /// `extent` is the hierarchy's; the third axis is the fastest.
    #[inline(always)]
    pub(super) fn new(
        extent: f32,
        [origin, direction]: [[L; 3]; 2],
        third: usize,
        backwards: [bool; 3],
    ) -> Self {
        let ([x, y, z], [dx, dy, dz]) = (origin, direction);
        let one = L::splat(1.0);
        let [x_axis, y_axis, _] = axes_from(third);
        let t_per_z = one / direction[third];
        let least = direction[third].abs() * L::splat(LEAST_COMPONENT);
        let inverse = |axis: usize| {
            let size = direction[axis].abs().max(least);
            one / if backwards[axis] { -size } else { size }
        };
        let farthest = x.abs().max(y.abs()).max(z.abs());
        Self {
            padding: (L::splat(extent) + farthest) * L::splat(PADDING),
            inverse: [inverse(0), inverse(1), inverse(2)],
            shear: [direction[x_axis] * t_per_z, direction[y_axis] * t_per_z],
            t_per_z,
            a: dx * dx + dy * dy + dz * dz,
        }
    }
}
