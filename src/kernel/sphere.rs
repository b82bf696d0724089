//! A ray against a sphere.

use crate::lanes::{Lanes, Vector};

/// The line of a ray.
#[derive(Clone, Copy)]
pub(crate) struct Line<L> {
    pub(crate) origin: Vector<L>,
    /// What the origin's rounding to f32 left out; none where that is nothing, as of rays from the eye.
    pub(crate) origin_low: Option<Vector<L>>,
    pub(crate) direction: Vector<L>,
    /// a = d·d and 1/a.
    pub(crate) a: L,
    pub(crate) inverse_a: L,
}

impl<L: Lanes> Line<L> {
    /// The origin relative to a point: two roundings.
    #[inline(always)]
    pub(crate) fn origin_from(&self, point: Vector<L>) -> Vector<L> {
        let from_point = self.origin - point;
        match self.origin_low {
            Some(low) => from_point + low,
            None => from_point,
        }
    }
}

/// Where a line meets a sphere.
pub(crate) struct Meeting<L: Lanes> {
    /// The middle of the chord.
    pub(crate) closest_t: L,
    /// Half the chord; means nothing where there is none.
    pub(crate) half_t: L,
    /// Whether there is a chord.
    pub(crate) meets: L::Mask,
}

/// |o + t·d − c|² = r². The discriminant is taken as r² − l² with l the distance of the centre from the line, since
/// b² − 4ac loses the radius of a sphere far away: |δl| ≤ 6u·|o − c| for a radius above 32u·|o − c|, and the middle of the chord
/// is off by at most 8u·|o − c|, by proof (docs/accuracy.md). Source: Hearn and Baker, "Computer Graphics with
/// OpenGL", as used in Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray
/// Tracing Gems, 2019.
#[inline(always)]
pub(crate) fn meet<L: Lanes>(line: &Line<L>, center: Vector<L>, radius_squared: L, zero: L) -> Meeting<L> {
    let from_center = line.origin_from(center);
    let closest_t = -(from_center.dot(line.direction) * line.inverse_a);
    let closest = from_center + line.direction * closest_t;
    let half_squared = radius_squared - closest.length_squared();
    let half_t = (half_squared * line.inverse_a).max(zero).sqrt();
    Meeting { closest_t, half_t, meets: half_squared.ge(zero) }
}

impl<L: Lanes> Meeting<L> {
    /// The smallest t beyond the given one, and whether there is one.
    #[inline(always)]
    pub(crate) fn nearest(&self, t_min: L) -> (L, L::Mask) {
        let (near, far) = (self.closest_t - self.half_t, self.closest_t + self.half_t);
        let t = L::select(near.gt(t_min), near, far);
        (t, self.meets & t.gt(t_min))
    }

    /// Whether the ray starts nearer to the surface than `slack` / r. The distance that t stands for is t·|d|·cos θ, with
    /// cos θ = half a chord / r.
    #[inline(always)]
    pub(crate) fn touches(&self, line: &Line<L>, slack: L) -> L::Mask {
        let (near, far) = (self.closest_t - self.half_t, self.closest_t + self.half_t);
        let height_per_t = self.half_t * line.a;
        let is_near = |t: L| !(t * height_per_t).abs().gt(slack);
        self.meets & (is_near(near) | is_near(far))
    }

    /// For a ray that starts on this sphere one root is 0 and this is the other; it is there for a ray that goes inward.
    #[inline(always)]
    pub(crate) fn far_side(&self) -> L {
        self.closest_t + self.closest_t
    }
}
