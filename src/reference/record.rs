//! What is kept of a tree of rays besides its light: nothing for a picture, a number for its signature, or all of it.

use super::ray::Ray;
use super::shape::{Primitive, Shape};
use crate::ray_tree::{PrimitiveKind, RayTree, TreeHit, TreeLight};
use crate::signature::{self, Shadow};
use glam::DVec3;

/// A ray, and what arrives along it.
pub(super) struct Arrival<'a> {
    pub(super) ray: &'a Ray,
    /// Share of the light that reaches the eye.
    pub(super) weight: DVec3,
    pub(super) light: DVec3,
}

/// What a ray hits, and what light does there.
pub(super) struct Ending<'a> {
    pub(super) primitive: &'a Primitive,
    /// Whether the ray comes from outside.
    pub(super) entering: bool,
    pub(super) t: f64,
    pub(super) point: DVec3,
    /// n_g and n_s turned to the side the ray comes from.
    pub(super) facing_geometric: DVec3,
    pub(super) facing_shading: DVec3,
    /// Beer's law for all that leaves along the ray.
    pub(super) attenuation: DVec3,
    pub(super) local_light: DVec3,
}

/// Put together from the leaves up, as the recursion returns. The default is that of a ray that was not spawned, and of a
/// hit's lights before the first.
pub(super) trait Record: Default {
    /// Of a ray that hits nothing.
    fn miss(arrival: &Arrival<'_>) -> Self;
    /// Of a hit's lights so far and the next one in file order, with what it adds.
    fn with_light(self, next: Shadow, adds: DVec3) -> Self;
    /// Of a ray that hits a primitive, from those of its lights and of its mirrored and refracted ray.
    fn hit(arrival: &Arrival<'_>, ending: &Ending<'_>, lights: Self, children: [Self; 2]) -> Self;
}

impl Record for () {
    fn miss(_: &Arrival<'_>) {}
    fn with_light(self, _: Shadow, _: DVec3) {}
    fn hit(_: &Arrival<'_>, _: &Ending<'_>, (): Self, _: [Self; 2]) {}
}

/// As [`signature`] defines it.
impl Record for u64 {
    fn miss(_: &Arrival<'_>) -> Self {
        signature::miss()
    }

    fn with_light(self, next: Shadow, _: DVec3) -> Self {
        signature::with_light(self, next)
    }

    fn hit(_: &Arrival<'_>, ending: &Ending<'_>, lights: Self, [reflected, refracted]: [Self; 2]) -> Self {
        signature::hit(ending.primitive.id, lights, reflected, refracted)
    }
}

/// The whole tree.
#[derive(Default)]
pub(super) struct TreeRecord {
    lights: Vec<TreeLight>,
    pub(super) ray: Option<Box<RayTree>>,
}

impl TreeRecord {
    fn new(arrival: &Arrival<'_>, hit: Option<TreeHit>, [reflect, refract]: [Self; 2]) -> Self {
        let ray = RayTree {
            origin: arrival.ray.origin.to_array(),
            direction: arrival.ray.direction.to_array(),
            weight: arrival.weight.to_array(),
            hit,
            reflect: reflect.ray,
            refract: refract.ray,
            colour: arrival.light.to_array(),
        };
        Self { lights: Vec::new(), ray: Some(Box::new(ray)) }
    }
}

impl Record for TreeRecord {
    fn miss(arrival: &Arrival<'_>) -> Self {
        Self::new(arrival, None, <[Self; 2]>::default())
    }

    fn with_light(mut self, shadow: Shadow, adds: DVec3) -> Self {
        self.lights.push(TreeLight { shadow, adds: adds.to_array() });
        self
    }

    fn hit(arrival: &Arrival<'_>, ending: &Ending<'_>, lights: Self, children: [Self; 2]) -> Self {
        let kind = match ending.primitive.shape {
            Shape::Sphere { .. } => PrimitiveKind::Sphere,
            Shape::Triangle { .. } => PrimitiveKind::Triangle,
            Shape::Polygon { .. } => PrimitiveKind::Polygon,
        };
        let hit = TreeHit {
            kind,
            primitive: ending.primitive.id,
            material: ending.primitive.material,
            entering: ending.entering,
            t: ending.t,
            point: ending.point.to_array(),
            geometric_normal: ending.facing_geometric.to_array(),
            shading_normal: ending.facing_shading.to_array(),
            attenuation: ending.attenuation.to_array(),
            lights: lights.lights,
            local_light: ending.local_light.to_array(),
        };
        Self::new(arrival, Some(hit), children)
    }
}
