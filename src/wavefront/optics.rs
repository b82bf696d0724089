//! Mirror and refraction directions, and the shares of light that take them, in lanes.

use crate::lanes::{Double, Vector};

/// d − 2(d·n)n; of either side's normal.
#[inline(always)]
pub(super) fn mirrored<D: Double>(direction: Vector<D>, normal: Vector<D>) -> Vector<D> {
    let twice = direction.dot(normal) * D::splat(2.0);
    direction - normal * twice
}

/// How light meets the boundary between two media.
pub(super) struct Boundary<D: Double> {
    /// Index of refraction of the side the ray comes from, over that of the other.
    ratio: D,
    pub(super) cos_incident: D,
    /// 0 under total internal reflection.
    pub(super) cos_refracted: D,
    pub(super) is_total: D::Mask,
}

impl<D: Double> Boundary<D> {
    /// `normal` is on the side the ray comes from; `ior` is that of the inside relative to the outside.
    #[inline(always)]
    pub(super) fn new(direction: Vector<D>, normal: Vector<D>, ior: D, entering: D::Mask) -> Self {
        let (zero, one) = (D::splat(0.0), D::splat(1.0));
        let ratio = D::select(entering, one / ior, ior);
        let cos_incident = (-direction.dot(normal)).max(zero).min(one);
        // Snell's law: sin θ' = ratio · sin θ.
        let cos_squared = one - ratio * ratio * (one - cos_incident * cos_incident);
        let cos_refracted = cos_squared.max(zero).sqrt();
        Self { ratio, cos_incident, cos_refracted, is_total: cos_squared.le(zero) }
    }

    /// The refracted direction, unit; means nothing under total internal reflection.
    #[inline(always)]
    pub(super) fn refracted(&self, direction: Vector<D>, normal: Vector<D>) -> Vector<D> {
        let along_surface = (direction + normal * self.cos_incident) * self.ratio;
        (along_surface - normal * self.cos_refracted).normalized(D::splat(1.0))
    }

    /// Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", 1994. The cosine is that on the rarer side,
    /// which makes the reflectance reach 1 where total internal reflection begins.
    #[inline(always)]
    pub(super) fn reflectance(&self, ior: D, entering: D::Mask) -> D {
        let one = D::splat(1.0);
        let outer_is_rarer = ior.ge(one);
        let comes_from_rarer = (entering & outer_is_rarer) | (!entering & !outer_is_rarer);
        let cos_rarer = D::select(comes_from_rarer, self.cos_incident, self.cos_refracted);
        let root = (ior - one) / (ior + one);
        let r0 = root * root;
        let x = one - cos_rarer;
        let x_squared = x * x;
        let reflectance = r0 + (one - r0) * (x_squared * x_squared * x);
        D::select(self.is_total, one, reflectance)
    }
}
