//! The recursion: what a ray sees is the light at its hit, and shares of what its mirrored and refracted rays see.

use super::camera::View;
use super::certainty::{PrimaryHit, certain_hit};
use super::hierarchy::{Hierarchy, Hit};
use super::optics::{Boundary, beer, mirrored};
use super::precision::Precision;
use super::ray::{Departure, Ray};
use super::record::{Arrival, Ending, Record, TreeRecord};
use super::shape::{Meeting, Primitive, Surface};
use crate::film::SamplePattern;
use crate::ray_tree::PixelTree;
use crate::rays::RayCounts;
use crate::scene::{Light, Material, Scene};
use crate::signature::{self, Shadow};
use glam::{DVec2, DVec3};
use std::sync::atomic::{AtomicBool, Ordering};

/// A scene made ready for the f64 reference.
pub struct Tracer<'a> {
    scene: &'a Scene,
    view: View,
    hierarchy: Hierarchy,
    samples: SamplePattern,
    precision: Precision,
    stop: &'a AtomicBool,
}

/// What a hit knows of itself.
struct Shading<'a> {
    material: &'a Material,
    surface: Surface,
    primitive: &'a Primitive,
    precision: Precision,
    /// Along the ray; unit as far as the precision goes.
    direction: DVec3,
    /// Whether the ray comes from outside.
    entering: bool,
    /// n_g and n_s turned to the side the ray comes from.
    facing_geometric: DVec3,
    facing_shading: DVec3,
}

/// What a light that lies before a surface adds there unless something hides it.
struct Incoming {
    /// kd·Ii and ks·Ii.
    diffuse: DVec3,
    specular: DVec3,
    /// Unit, to the light, and its n·l.
    l: DVec3,
    cos_light: f64,
}

/// A ray that a hit gives rise to, and the share of what it sees that the hit passes on.
struct Child {
    direction: DVec3,
    share: DVec3,
    /// Whether it stays on the side of the surface that the ray came from.
    reflected: bool,
}

impl<'a> Tracer<'a> {
    /// Builds the hierarchy. Once `stop` is set, rays return black, so that even a deep tree of rays ends soon.
    #[must_use]
    pub fn new(scene: &'a Scene, stop: &'a AtomicBool) -> Self {
        Self::with_precision(scene, Precision::F64, stop)
    }

    /// The same, with a say in what rays and hits are kept in.
    #[must_use]
    pub fn with_precision(scene: &'a Scene, precision: Precision, stop: &'a AtomicBool) -> Self {
        Self {
            scene,
            view: View::new(&scene.camera, &scene.image),
            hierarchy: Hierarchy::new(Primitive::all(&scene.geometry, &scene.materials)),
            samples: SamplePattern::new(&scene.render),
            precision,
            stop,
        }
    }

    /// The mean of a pixel's samples, linear RGB; x and y count from the full image's top left. Means nothing once the
    /// tracer was told to stop.
    pub fn pixel(&self, x: u32, y: u32, counts: &mut RayCounts) -> [f64; 3] {
        let mut sum = DVec3::ZERO;
        for s in 0..self.samples.count() {
            let (light, ()) = self.sample(x, y, s, counts);
            sum += light;
        }
        (sum / f64::from(self.samples.count())).to_array()
    }

    /// The signature of a pixel's rays: it depends on which primitive every ray of every sample hit and which lights every
    /// hit found visible, and on nothing else. Means nothing once the tracer was told to stop.
    #[must_use]
    pub fn signature(&self, x: u32, y: u32) -> u64 {
        let counts = &mut RayCounts::default();
        (0..self.samples.count()).fold(0, |samples, s| {
            let (_, node) = self.sample(x, y, s, counts);
            signature::with_sample(samples, node)
        })
    }

    /// Every ray of a pixel and all that it meets. Means nothing once the tracer was told to stop.
    #[must_use]
    pub fn tree(&self, x: u32, y: u32) -> PixelTree {
        let counts = &mut RayCounts::default();
        let mut sum = DVec3::ZERO;
        let mut samples = Vec::new();
        for s in 0..self.samples.count() {
            let (light, record) = self.sample::<TreeRecord>(x, y, s, counts);
            sum += light;
            samples.extend(record.ray.map(|ray| *ray));
        }
        PixelTree { colour: (sum / f64::from(self.samples.count())).to_array(), samples }
    }

    /// What the ray of a pixel's sample s sees, in f64 whatever the tracer's precision, and whether an engine in f32 has to
    /// see the same.
    #[must_use]
    pub fn primary_hit(&self, x: u32, y: u32, s: u32) -> PrimaryHit {
        let (origin, direction) = self.through_sample(x, y, s);
        let ray = Ray::new(origin, direction, None);
        let id = self.hierarchy.closest(&ray).map(|hit| hit.primitive.id);
        PrimaryHit { id, is_certain: certain_hit(&self.hierarchy, &ray, f64::INFINITY) == Some(id) }
    }

    pub(super) fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    fn sample<R: Record>(&self, x: u32, y: u32, s: u32, counts: &mut RayCounts) -> (DVec3, R) {
        let (origin, direction) = self.through_sample(x, y, s);
        counts.primary += 1;
        self.radiance(&self.precision.ray(origin, direction, None), DVec3::ONE, 0, counts)
    }

    /// Origin and direction of the primary ray of a pixel's sample.
    fn through_sample(&self, x: u32, y: u32, s: u32) -> (DVec3, DVec3) {
        let row_from_bottom = self.scene.image.height - 1 - y;
        let corner = DVec2::new(f64::from(x), f64::from(row_from_bottom));
        self.view.ray(corner + DVec2::from(self.samples.position(x, y, s)))
    }

    /// What arrives along a ray, and the record of how. Its weight is how much of that reaches the eye.
    fn radiance<R: Record>(
        &self,
        ray: &Ray,
        weight: DVec3,
        depth: u32,
        counts: &mut RayCounts,
    ) -> (DVec3, R) {
        if self.stop.load(Ordering::Relaxed) {
            return (DVec3::ZERO, R::default());
        }
        let Some(hit) = self.hierarchy.closest(ray) else {
            let light = self.scene.image.background.as_dvec3();
            return (light, R::miss(&Arrival { ray, weight, light }));
        };
        let shading = self.shading(ray, &hit);
        let attenuation = match shading.material.dielectric {
            Some(dielectric) if !shading.entering => {
                beer(dielectric.absorption.as_dvec3(), hit.t * ray.direction.length())
            }
            _ => DVec3::ONE,
        };
        let (local_light, lights) = self.local_light::<R>(&shading, counts);
        let mut sum = local_light;
        let mut records = <[R; 2]>::default();
        for (child, record) in shading.children().into_iter().zip(&mut records) {
            let Some(child) = child else { continue };
            let child_weight = weight * attenuation * child.share;
            if depth == self.scene.render.max_depth || !self.is_worth_tracing(child_weight) {
                continue;
            }
            if child.reflected {
                counts.reflect += 1;
            } else {
                counts.refract += 1;
            }
            let ray = shading.leave(child.reflected, child.direction);
            let (seen, seen_record) = self.radiance(&ray, child_weight, depth + 1, counts);
            sum += child.share * seen;
            *record = seen_record;
        }
        let light = attenuation * sum;
        let ending = shading.ending(hit.t, attenuation, local_light);
        (light, R::hit(&Arrival { ray, weight, light }, &ending, lights, records))
    }

    fn is_worth_tracing(&self, weight: DVec3) -> bool {
        let largest = weight.max_element();
        largest > 0.0 && largest >= f64::from(self.scene.render.min_weight)
    }

    fn shading<'s>(&'s self, ray: &Ray, hit: &Hit<'s>) -> Shading<'s> {
        let surface = self.precision.surface(&hit.primitive.surface(ray, hit.t));
        let direction = ray.direction;
        let entering = direction.dot(surface.geometric_normal) < 0.0;
        let turn = if entering { 1.0 } else { -1.0 };
        Shading {
            material: &self.scene.materials[hit.primitive.material.0 as usize],
            primitive: hit.primitive,
            precision: self.precision,
            direction,
            entering,
            facing_geometric: turn * surface.geometric_normal,
            facing_shading: turn * surface.shading_normal,
            surface,
        }
    }

    /// ka·Ia + Σ over visible lights of kd·Ii·(n·l) + ks·Ii·max(0, n·h)^α. Lambert's law, and Blinn, "Models of Light
    /// Reflection for Computer Synthesized Pictures", 1977.
    fn local_light<R: Record>(&self, shading: &Shading<'_>, counts: &mut RayCounts) -> (DVec3, R) {
        let mut sum = shading.material.ambient.as_dvec3() * self.scene.ambient.as_dvec3();
        let mut lights = R::default();
        for light in &self.scene.lights {
            let (shadow, adds) = match shading.incoming(light) {
                None => (Shadow::NotTraced, DVec3::ZERO),
                Some(incoming) if self.is_visible(light, shading, counts) => {
                    (Shadow::Visible, shading.reflected(&incoming))
                }
                Some(_) => (Shadow::Hidden, DVec3::ZERO),
            };
            sum += adds;
            lights = lights.with_light(shadow, adds);
        }
        (sum, lights)
    }

    fn is_visible(&self, light: &Light, shading: &Shading<'_>, counts: &mut RayCounts) -> bool {
        counts.shadow += 1;
        match *light {
            Light::Point { position, .. } => {
                let light = position.as_dvec3();
                let ray = shading.leave(true, light - shading.surface.point);
                // Rounding must not put a surface that the light lies on in front of the light.
                let coordinates = light.abs().max(ray.origin.abs()).max_element();
                let uncertainty = Meeting::ROUNDING * coordinates / ray.direction.length();
                !self.hierarchy.occluded(&ray, 1.0 - uncertainty, self.precision.reach(ray.direction))
            }
            Light::Directional { direction, .. } => {
                let ray = shading.leave(true, -direction.as_dvec3());
                !self.hierarchy.occluded(&ray, f64::INFINITY, 0.0)
            }
        }
    }
}

impl Shading<'_> {
    /// None where the light is behind the surface or could add nothing.
    fn incoming(&self, light: &Light) -> Option<Incoming> {
        let (to_light, intensity) = match *light {
            Light::Point { position, intensity } => (position.as_dvec3() - self.surface.point, intensity),
            Light::Directional { direction, intensity } => (-direction.as_dvec3(), intensity),
        };
        let diffuse = self.material.diffuse.as_dvec3() * intensity.as_dvec3();
        let specular = self.material.specular.as_dvec3() * intensity.as_dvec3();
        if diffuse == DVec3::ZERO && specular == DVec3::ZERO {
            return None;
        }
        let l = to_light.try_normalize()?;
        let cos_light = self.facing_shading.dot(l);
        let is_before = cos_light > 0.0 && self.facing_geometric.dot(l) > 0.0;
        is_before.then_some(Incoming { diffuse, specular, l, cos_light })
    }

    /// kd·Ii·(n·l) + ks·Ii·max(0, n·h)^α.
    fn reflected(&self, incoming: &Incoming) -> DVec3 {
        let half = (incoming.l - self.direction).normalize();
        let cos_half = self.facing_shading.dot(half).max(0.0);
        incoming.diffuse * incoming.cos_light
            + incoming.specular * cos_half.powf(f64::from(self.material.shininess))
    }

    /// The mirrored and the refracted ray, where there are such.
    fn children(&self) -> [Option<Child>; 2] {
        let mirror = self.material.mirror.as_dvec3();
        let (reflected_share, refracted) = match &self.material.dielectric {
            None => (mirror, None),
            Some(dielectric) => {
                let boundary =
                    |normal| Boundary::new(self.direction, normal, f64::from(dielectric.ior), self.entering);
                // A vertex normal that faces away from the ray has no angle of incidence.
                let faces_ray = self.direction.dot(self.facing_shading) < 0.0;
                let normal = if faces_ray { self.facing_shading } else { self.facing_geometric };
                let at_normal = boundary(normal);
                let (reflected_share, refracted_share) = at_normal.shares(mirror, dielectric, self.entering);
                // A refracted ray that stays on this side of the true surface is made with the true normal.
                let direction = at_normal
                    .refracted(self.direction, normal)
                    .filter(|direction| direction.dot(self.facing_geometric) < 0.0)
                    .or_else(|| {
                        boundary(self.facing_geometric).refracted(self.direction, self.facing_geometric)
                    });
                let child = |direction| Child { direction, share: refracted_share, reflected: false };
                (reflected_share, direction.map(child))
            }
        };
        let direction = Some(mirrored(self.direction, self.facing_shading))
            .filter(|direction| direction.dot(self.facing_geometric) > 0.0)
            .unwrap_or_else(|| mirrored(self.direction, self.facing_geometric));
        [Some(Child { direction: direction.normalize(), share: reflected_share, reflected: true }), refracted]
    }

    /// For a record.
    fn ending(&self, t: f64, attenuation: DVec3, local_light: DVec3) -> Ending<'_> {
        Ending {
            primitive: self.primitive,
            entering: self.entering,
            t,
            point: self.surface.point,
            facing_geometric: self.facing_geometric,
            facing_shading: self.facing_shading,
            attenuation,
            local_light,
        }
    }

    /// A ray that leaves the surface, on the side the ray came from or on the other.
    fn leave(&self, same_side: bool, direction: DVec3) -> Ray {
        let inward = self.entering != same_side;
        let off_surface = self.precision.reach(self.surface.point);
        let departure = Departure { from: self.primitive.id, inward, off_surface };
        self.precision.ray(self.surface.point, direction, Some(departure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{
        Camera, Dielectric, Fresnel, Geometry, ImageSettings, MaterialId, PrimitiveId, Projection,
        RenderSettings, Rgb,
    };
    use glam::Vec3;

    /// A closed convex solid, an octahedron off any grid, and its edges.
    fn octahedron(center: Vec3, size: f32) -> (Scene, Vec<[usize; 2]>) {
        let axes = [Vec3::new(0.9, 0.3, -0.2), Vec3::new(-0.3, 0.8, 0.4), Vec3::new(0.25, -0.35, 0.85)];
        let corners =
            [axes[0], -axes[0], axes[1], -axes[1], axes[2], -axes[2]].map(|axis| center + size * axis);
        let mut geometry = Geometry::default();
        geometry.add_vertices(corners).unwrap();
        let mut edges = Vec::new();
        for (x, y, z) in (0..8_u32).map(|octant| (octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2))) {
            // Counter-clockwise from outside: a mirrored octant turns the other way.
            let is_mirrored = (x + y + z) % 2 == 1;
            let corners = if is_mirrored { [x, z, y] } else { [x, y, z] };
            geometry.add_triangle(corners, None, MaterialId(0)).unwrap();
            edges.extend([[x, y], [y, z], [z, x]].map(|edge| edge.map(|index| index as usize)));
        }
        let scene = Scene {
            image: ImageSettings::default(),
            render: RenderSettings::default(),
            camera: Camera {
                eye: center + 9.0 * size * Vec3::ONE,
                target: center,
                up: Vec3::Y,
                projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
            },
            ambient: Rgb::ZERO,
            lights: Vec::new(),
            materials: vec![Material::grey()],
            geometry,
        };
        (scene, edges)
    }

    /// Runs a test on points of the edges and corners of solids of several places and sizes, in f64, as no pixel aims:
    /// it gets a tracer, the solid's centre and size, a count and the point.
    fn at_edges(points_a_solid: usize, mut test: impl FnMut(&Tracer<'_>, DVec3, f64, f64, DVec3)) {
        let stop = AtomicBool::new(false);
        for (center, size) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-9), (Vec3::new(1e4, -2e4, 3e3), 1.0)] {
            let (scene, edges) = octahedron(center, size);
            let tracer = Tracer::new(&scene, &stop);
            let vertex = |index: usize| scene.geometry.vertices[index].as_dvec3();
            for (step, [a, b]) in edges.iter().cycle().take(points_a_solid).enumerate() {
                let point = vertex(*a) + (step % 101) as f64 / 100.0 * (vertex(*b) - vertex(*a));
                test(&tracer, center.as_dvec3(), f64::from(size), step as f64, point);
            }
        }
    }

    /// From inside a closed solid every ray ends on it.
    #[test]
    fn no_ray_gets_out_through_an_edge_or_a_corner() {
        at_edges(24_000, |tracer, center, size, step, point| {
            let aside = DVec3::new(step.sin(), (step * 0.7).cos(), (step * 0.3).sin());
            let eye = center + 0.2 * size * aside;
            let hit = tracer.hierarchy.closest(&Ray::new(eye, point - eye, None));
            assert!(hit.is_some(), "at {point} of the solid at {center}, step {step}");
        });
    }

    /// The point hit lies on two faces or more, to rounding, and none of them may hide from it what stands before all of
    /// them: from a point of a convex solid that it sees, the eye is not hidden.
    #[test]
    fn a_point_on_an_edge_is_not_shadowed_by_the_faces_that_meet_there() {
        let mut hits = 0;
        at_edges(6000, |tracer, center, size, step, point| {
            let (x, y) = (step * 0.37, step * 0.11);
            let eye = center + 20.0 * size * DVec3::new(x.sin(), y.cos(), (x + y).sin());
            let ray = Ray::new(eye, (point - eye).normalize(), None);
            // A ray at the silhouette may miss, or meet a face first that is seen from inside.
            let Some(hit) = tracer.hierarchy.closest(&ray) else { return };
            let shading = tracer.shading(&ray, &hit);
            if shading.entering {
                hits += 1;
                let back = shading.leave(true, eye - shading.surface.point);
                let hidden = tracer.hierarchy.occluded(&back, 1.0, 0.0);
                assert!(!hidden, "at {point} of the solid at {center}, step {step}");
            }
        });
        assert!(hits > 9000, "{hits} rays hit");
    }

    /// One ray straight down on a square, with lights before it, behind a lid and behind the square.
    fn one_ray(material: Material) -> Scene {
        let mut geometry = Geometry::default();
        for (low, high, z) in [(-9.0, 9.0, 0.0), (1.0, 3.0, 3.0)] {
            let corners = [[low, low], [high, low], [high, high], [low, high]];
            let corners = corners.map(|[x, y]| Vec3::new(x, y, z));
            geometry.add_polygon(&corners, None, MaterialId(0)).unwrap();
        }
        let light = |x, y, z| Light::Point { position: Vec3::new(x, y, z), intensity: Rgb::ONE };
        Scene {
            image: ImageSettings { width: 1, height: 1, background: Rgb::ONE },
            render: RenderSettings::default(),
            camera: Camera {
                eye: Vec3::new(0.0, 0.0, 5.0),
                target: Vec3::ZERO,
                up: Vec3::Y,
                projection: Projection::OrthographicHeight { height: 1.0 },
            },
            ambient: Rgb::ZERO,
            lights: vec![light(0.1, 0.2, 9.0), light(4.0, 4.0, 6.0), light(0.0, 0.0, -3.0)],
            materials: vec![material],
            geometry,
        }
    }

    #[test]
    fn a_signature_is_folded_from_hits_lights_and_children() {
        let matte = Material::grey();
        let mirror = Material { mirror: Rgb::ONE, ..matte };
        let glass =
            Dielectric { ior: 1.5, absorption: Rgb::ZERO, transmission: Rgb::ONE, fresnel: Fresnel::Schlick };
        let glass = Material { dielectric: Some(glass), ..matte };
        let dark = Material { diffuse: Rgb::ZERO, specular: Rgb::ZERO, ..matte };
        let fold = |shadows: [Shadow; 3]| shadows.into_iter().fold(0, signature::with_light);
        let traced = fold([Shadow::Visible, Shadow::Hidden, Shadow::NotTraced]);
        for (name, material, lights, reflected, refracted) in [
            ("matte", matte, traced, 0, 0),
            ("mirror", mirror, traced, signature::miss(), 0),
            ("glass", glass, traced, signature::miss(), signature::miss()),
            ("dark", dark, fold([Shadow::NotTraced; 3]), 0, 0),
        ] {
            let scene = one_ray(material);
            let node = signature::hit(PrimitiveId(0), lights, reflected, refracted);
            for precision in [Precision::F64, Precision::F32Queues] {
                let stop = AtomicBool::new(false);
                let tracer = Tracer::with_precision(&scene, precision, &stop);
                assert_eq!(tracer.signature(0, 0), signature::with_sample(0, node), "{name}, {precision:?}");
            }
        }
    }

    #[test]
    fn a_signature_is_folded_over_the_samples() {
        let mut scene = one_ray(Material::grey());
        // The square's right edge parts the samples.
        (scene.camera.eye.x, scene.camera.target.x, scene.render.samples) = (9.0, 9.0, 2);
        let lights = [Shadow::Visible, Shadow::Visible, Shadow::NotTraced];
        let hit = signature::hit(PrimitiveId(0), lights.into_iter().fold(0, signature::with_light), 0, 0);
        let nodes = [hit, signature::miss(), hit, signature::miss()];
        let stop = AtomicBool::new(false);
        let found = Tracer::new(&scene, &stop).signature(0, 0);
        assert_eq!(found, nodes.into_iter().fold(0, signature::with_sample));
    }
}
