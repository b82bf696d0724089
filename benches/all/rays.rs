//! Rays as scenes have them, from those that all go one way to those that go anywhere.

use crate::random::Random;
use glam::DVec3;
use rayon::prelude::*;
use std::num::NonZeroU64;
use std::sync::atomic::AtomicBool;
use wavelane::film::Region;
use wavelane::lanes::Width;
use wavelane::rays::{Found, RayKind, RaySet};
use wavelane::reference::Tracer;
use wavelane::render::{DEFAULT_BATCH, Engine, RenderOptions, render};
use wavelane::scene::{Light, Scene};
use wavelane::trace::Query;

/// What rays are for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// From the eye, in the order in which a frame traces them.
    Primary,
    /// From each primary hit to the first light.
    Shadow,
    /// From each primary hit as a mirror would have it.
    Reflect,
    /// From each primary hit to anywhere above the surface, as a diffuse surface would have it; neighbours start side by side.
    Diffuse,
    /// The same ones in no order.
    DiffuseShuffled,
}

impl Kind {
    pub(crate) const ALL: [Self; 5] =
        [Self::Primary, Self::Shadow, Self::Reflect, Self::Diffuse, Self::DiffuseShuffled];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Reflect => "reflect",
            Self::Diffuse => "diffuse",
            Self::DiffuseShuffled => "diffuse_shuffled",
        }
    }

    pub(crate) fn query(self) -> Query {
        if self == Self::Shadow { Query::Any } else { Query::Closest }
    }
}

/// Primary rays of a scene's picture, with what they hit.
pub(crate) fn primary(scene: &Scene) -> RaySet {
    // Without lights no shadow rays are traced, which nobody asked for.
    let mut scene = Scene { lights: Vec::new(), ..scene.clone() };
    scene.render.max_depth = 0;
    let options = RenderOptions {
        engine: Engine::Wavefront {
            width: Width::BEST,
            batch: DEFAULT_BATCH,
            records: false,
            rays: NonZeroU64::new(1),
        },
        region: Region::whole(scene.image.width, scene.image.height),
        threads: 1,
        on_progress: &|_| {},
        stop: &AtomicBool::new(false),
    };
    render(&scene, &options).unwrap().recorded.of(RayKind::Primary).clone()
}

/// How many rays of a kind there are.
pub(crate) fn count(kind: Kind, primary: &RaySet) -> usize {
    match kind {
        Kind::Primary => primary.len(),
        _ => primary.found.iter().filter(|found| found.id.is_some()).count(),
    }
}

/// Rays of a kind. They start a little off the surface, 10⁻⁴ of its coordinates, so that every tracer can be given them: one
/// that is not told what a ray starts on too.
pub(crate) fn of(kind: Kind, scene: &Scene, primary: &RaySet, tracer: &Tracer<'_>) -> RaySet {
    if kind == Kind::Primary {
        return RaySet { rows: primary.rows.clone(), ..RaySet::default() };
    }
    let random = Random::new(7);
    let hits: Vec<(usize, &Found)> =
        primary.found.iter().enumerate().filter(|(_, found)| found.id.is_some()).collect();
    let child = |index: usize, &(row, found): &(usize, &Found)| {
        let stretch = primary.stretch(row).unwrap();
        let direction = stretch.direction.normalize();
        let point = stretch.origin + stretch.direction * f64::from(found.t);
        // Of a hit that the reference does not see, at an edge, the normal faces the ray.
        let normal = tracer.closest(&stretch).map_or(-direction, |met| met.geometric_normal);
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let start = point + normal * 1e-4 * point.abs().max_element().max(1e-3);
        let (direction, t_max) = match kind {
            Kind::Shadow => to_light(&scene.lights[0], start),
            Kind::Reflect => (direction - 2.0 * direction.dot(normal) * normal, f32::INFINITY),
            _ => (above(normal, random.pair(index, 0)), f32::INFINITY),
        };
        let ([ox, oy, oz], [dx, dy, dz]) = (start.as_vec3().to_array(), direction.as_vec3().to_array());
        [ox, oy, oz, 0.0, dx, dy, dz, t_max]
    };
    let mut rows: Vec<[f32; 8]> = hits.par_iter().enumerate().map(|(index, hit)| child(index, hit)).collect();
    if kind == Kind::DiffuseShuffled {
        let key = |index: usize| random.pair(index, 1)[0];
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by(|&a, &b| key(a).total_cmp(&key(b)));
        rows = order.into_iter().map(|index| rows[index]).collect();
    }
    RaySet { rows, ..RaySet::default() }
}

fn to_light(light: &Light, start: DVec3) -> (DVec3, f32) {
    match light {
        Light::Point { position, .. } => (position.as_dvec3() - start, 1.0),
        Light::Directional { direction, .. } => (-direction.as_dvec3(), f32::INFINITY),
    }
}

/// A direction above a surface, as likely as a diffuse surface reflects into it: from the foot of a unit sphere that lies on
/// the surface to a random point of that sphere, which is kept from being the foot itself.
fn above(normal: DVec3, [height, turn]: [f64; 2]) -> DVec3 {
    let z = 2.0 * height - 1.0;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (turn * std::f64::consts::TAU).sin_cos();
    (normal + 0.999 * DVec3::new(radius * cosine, radius * sine, z)).normalize()
}
