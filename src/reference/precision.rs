//! In what precision rays and hits are kept from one step of the recursion to the next.

use super::ray::{Departure, Ray};
use super::shape::Surface;
use glam::DVec3;

/// What rays and hits are kept in between the steps. The steps themselves compute in f64 either way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// f64: the truth.
    #[default]
    F64,
    /// f32, as in an engine whose queues hold origins, directions, hit points and normals in f32. How far its picture is
    /// off the truth is the floor: no arithmetic brings an engine with such queues nearer.
    F32Queues,
}

impl Precision {
    /// Half the spacing of f32 numbers around 1.
    pub(super) const ROUNDING: f64 = 1.0 / (1 << 24) as f64;

    /// What is left of a vector once it has been kept; each component is rounded to nearest.
    fn kept(self, vector: DVec3) -> DVec3 {
        match self {
            Self::F64 => vector,
            Self::F32Queues => vector.as_vec3().as_dvec3(),
        }
    }

    /// A ray as it is kept. The length of its direction is rounded too and not mended.
    pub(super) fn ray(self, origin: DVec3, direction: DVec3, departure: Option<Departure>) -> Ray {
        Ray::new(self.kept(origin), self.kept(direction), departure)
    }

    /// A hit as it is kept.
    pub(super) fn surface(self, surface: &Surface) -> Surface {
        Surface {
            point: self.kept(surface.point),
            geometric_normal: self.kept(surface.geometric_normal),
            shading_normal: self.kept(surface.shading_normal),
        }
    }

    /// How near a kept vector's end counts as on a surface that the true one ends on, 2·2⁻²⁴ of its length; 0 in f64,
    /// whose rounding the meeting with that surface knows. Divided by the speed at which a ray meets that surface, it
    /// bounds the ray's parameter between the two.
    ///
    /// Every component is rounded by at most 2⁻²⁴ of itself, so the end moves by at most δ = 2⁻²⁴ of the vector's length. A
    /// plane through the true end is then no farther than δ/cos θ along a ray. A sphere bends: with b = r·cos θ at the
    /// end, δ below it, the ray leaves at t = 2rδ/(2b + t), and meets it there at the cosine (b + t)/r, so
    /// t·cos θ' = δ·(2b + 2t)/(2b + t), which is δ head-on, 2δ at the limb and in between elsewhere.
    pub(super) fn reach(self, vector: DVec3) -> f64 {
        match self {
            Self::F64 => 0.0,
            Self::F32Queues => 2.0 * Self::ROUNDING * vector.length(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_in_f64_is_kept_whole() {
        let vector = DVec3::new(0.1, -1e300, f64::MIN_POSITIVE);
        assert_eq!((Precision::F64.kept(vector), Precision::F64.reach(vector)), (vector, 0.0));
    }

    #[test]
    fn what_is_kept_in_f32_is_off_by_no_more_than_half_the_reach() {
        let mut worst: f64 = 0.0;
        for step in 0..10_000 {
            let step = f64::from(step);
            let vector = 1.1_f64.powf(step % 100.0) * DVec3::new(step.sin(), (0.7 * step).cos(), 1e-3);
            let off = (Precision::F32Queues.kept(vector) - vector).length();
            worst = worst.max(off / Precision::F32Queues.reach(vector));
        }
        assert!((0.3..=0.5).contains(&worst), "{worst}");
    }
}
