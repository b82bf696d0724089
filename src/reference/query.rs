//! Questions about single rays: what one meets first, or whether anything is in its way, and whether an engine in f32 has
//! to give the same answer.

use super::certainty::{certain_hit, certain_shadow};
use super::precision::Precision;
use super::ray::{Departure, Ray};
use super::shape::Shape;
use super::tracer::Tracer;
use crate::rays::Stretch;
use crate::scene::PrimitiveId;
use glam::DVec3;

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The ray's parameter, not a length.
    pub t: f64,
    /// The primitive.
    pub id: PrimitiveId,
    /// n_g and n_s, unit, outward.
    pub geometric_normal: DVec3,
    /// n_s on the side of n_g, unit.
    pub shading_normal: DVec3,
    /// What rounding every coordinate of the primitive, taken relative to the ray's origin, by 2⁻²⁴ of the largest distance
    /// between the two does to t: u·L / (|d|·cos θ). The error of t in this unit is the backward error: how far the primitive
    /// would have to be moved for the answer to be right.
    pub t_per_rounding: f64,
}

impl Tracer<'_> {
    /// The closest hit of a ray.
    #[must_use]
    pub fn closest(&self, stretch: &Stretch) -> Option<Met> {
        let ray = self.ray(stretch);
        let hit = self.hierarchy().closest(&ray).filter(|hit| hit.t < stretch.t_max)?;
        let surface = hit.primitive.surface(&ray, hit.t);
        let farthest = match &hit.primitive.shape {
            Shape::Sphere { center, radius } => center.distance(ray.origin) + radius,
            Shape::Triangle { vertices, .. } => farthest(vertices, ray.origin),
            Shape::Polygon { vertices, .. } => farthest(vertices, ray.origin),
        };
        let approach = surface.geometric_normal.dot(ray.direction).abs();
        Some(Met {
            t: hit.t,
            id: hit.primitive.id,
            geometric_normal: surface.geometric_normal,
            shading_normal: surface.shading_normal,
            t_per_rounding: Precision::ROUNDING * farthest / approach,
        })
    }

    /// Whether anything that casts a shadow is in the way of a ray; if it leaves a primitive, as shadow rays do, apart from
    /// surfaces that its end is on as far as f32 can tell.
    #[must_use]
    pub fn occluded(&self, stretch: &Stretch) -> bool {
        let ray = self.ray(stretch);
        let off_surface = match (stretch.t_max, stretch.departure) {
            // A stretch that was given as such ends where it ends, not at a light that it was aimed at.
            (f64::INFINITY, _) | (_, None) => 0.0,
            (t_max, Some(_)) => Precision::F32Queues.reach(t_max * ray.direction),
        };
        self.hierarchy().occluded(&ray, stretch.t_max, off_surface)
    }

    /// The closest primitive, or the miss, that every engine finds whose only fault is rounding to f32; none where they may
    /// differ.
    #[must_use]
    pub fn certain_closest(&self, stretch: &Stretch) -> Option<Option<PrimitiveId>> {
        let (ray, t_max) = self.unit_ray(stretch);
        certain_hit(self.hierarchy(), &ray, t_max)
    }

    /// Whether every such engine finds the ray occluded, or not; none where they may differ.
    #[must_use]
    pub fn certain_occluded(&self, stretch: &Stretch) -> Option<bool> {
        let (ray, t_max) = self.unit_ray(stretch);
        certain_shadow(self.hierarchy(), &ray, t_max)
    }

    fn ray(&self, stretch: &Stretch) -> Ray {
        let departure = stretch.departure.map(|departure| Departure {
            from: departure.from,
            inward: departure.inward,
            off_surface: 0.0,
        });
        Ray { t_min: stretch.t_min, ..Ray::new(stretch.origin, stretch.direction, departure) }
    }

    /// The same ray with a direction of length 1, and its end.
    fn unit_ray(&self, stretch: &Stretch) -> (Ray, f64) {
        let length = stretch.direction.length();
        let unit = Stretch {
            direction: stretch.direction / length,
            t_min: stretch.t_min * length,
            t_max: stretch.t_max * length,
            ..*stretch
        };
        (self.ray(&unit), unit.t_max)
    }
}

fn farthest(points: &[DVec3], from: DVec3) -> f64 {
    points.iter().map(|point| point.distance(from)).fold(0.0, f64::max)
}
