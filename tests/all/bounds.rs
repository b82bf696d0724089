//! Bounds on what follows a hit, as docs/accuracy.md states them, on recorded rays of whole frames.

use crate::support::{STILL_LIFE, render_with, root, scene};
use glam::DVec3;
use std::num::NonZeroU64;
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::rays::{RayKind, RecordedRays};
use wavelane::reference::Tracer;
use wavelane::render::Engine;
use wavelane::scene::{Geometry, PrimitiveId, Scene};

/// 2⁻²⁴.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The example scenes, small, and one of each kind of primitive.
fn scenes() -> Vec<Scene> {
    let names = ["glass", "mesh", "polygons", "sphereflake", "isometric"];
    let file = |name: &str| load(&root().join(format!("scenes/{name}.toml"))).unwrap().scene;
    let mut scenes: Vec<Scene> = names.into_iter().map(file).chain([scene(STILL_LIFE)]).collect();
    for scene in &mut scenes {
        (scene.image.width, scene.image.height) = (120, 90);
        scene.render.samples = 1;
    }
    scenes
}

fn record(scene: &Scene) -> RecordedRays {
    let rays = NonZeroU64::new(1);
    render_with(scene, Engine::Wavefront { width: Width::BEST, batch: 4096, records: false, rays }).recorded
}

/// How far a point is off a primitive's surface, and the largest coordinate of the primitive.
fn off_surface(geometry: &Geometry, id: PrimitiveId, point: DVec3) -> (f64, f64) {
    if let Ok(index) = geometry.spheres.binary_search_by_key(&id, |sphere| sphere.id) {
        let sphere = &geometry.spheres[index];
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        return ((point.distance(center) - radius).abs(), center.abs().max_element() + radius);
    }
    let corner = |index: u32| geometry.vertices[index as usize].as_dvec3();
    let corners: Vec<DVec3> =
        if let Ok(index) = geometry.triangles.binary_search_by_key(&id, |triangle| triangle.id) {
            geometry.triangles[index].vertices.map(corner).into()
        } else {
            let index = geometry.polygons.binary_search_by_key(&id, |polygon| polygon.id).unwrap();
            geometry.polygons[index].vertices.clone().map(corner).collect()
        };
    let first = corners[0];
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let normal: DVec3 = edges.map(|(from, to)| (from - first).cross(to - first)).sum();
    let extent = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    ((point - first).dot(normal.normalize()).abs(), extent)
}

#[test]
fn a_secondary_ray_starts_on_its_surface_to_47_bits_of_the_coordinates() {
    let (mut rays, mut worst, mut in_f32) = (0, 0.0_f64, 0.0_f64);
    for scene in scenes() {
        let recorded = record(&scene);
        for kind in [RayKind::Shadow, RayKind::Reflect, RayKind::Refract] {
            let set = recorded.of(kind);
            for (row, start) in set.starts.iter().enumerate() {
                let stretch = set.stretch(row).unwrap();
                let (off, extent) = off_surface(&scene.geometry, start.departure.from, stretch.origin);
                let coordinates = extent.max(stretch.origin.abs().max_element());
                worst = worst.max(off / coordinates);
                let [x, y, z, ..] = set.rows[row].map(f64::from);
                let (off, _) = off_surface(&scene.geometry, start.departure.from, DVec3::new(x, y, z));
                in_f32 = in_f32.max(off / coordinates);
                rays += 1;
            }
        }
    }
    assert!(rays > 30_000, "{rays}");
    assert!(worst <= 1.0 / (1_u64 << 47) as f64, "{worst:e} of the coordinates");
    assert!(in_f32 > 0.2 * U, "what rounding to f32 leaves out is needed: {in_f32:e}");
}

#[test]
fn normals_of_primary_hits_are_rounded_once() {
    let (mut hits, mut worst) = (0, 0.0_f64);
    let stop = AtomicBool::new(false);
    for scene in scenes() {
        let recorded = record(&scene);
        let tracer = Tracer::new(&scene, &stop);
        let primary = recorded.of(RayKind::Primary);
        for (row, found) in primary.found.iter().enumerate() {
            let Some(met) = tracer.closest(&primary.stretch(row).unwrap()) else { continue };
            if found.id != Some(met.id) {
                continue; // another test's business
            }
            let normal = DVec3::from(found.shading_normal.map(f64::from));
            // On the ray's side.
            let off = normal.distance(met.shading_normal).min(normal.distance(-met.shading_normal));
            worst = worst.max(off);
            hits += 1;
        }
    }
    assert!(hits > 20_000, "{hits}");
    // Each of three components by at most 2⁻²⁵ of the power of two above it.
    assert!(worst <= 1.01 * U, "{} of 2^-24", worst / U);
}

#[test]
fn reflected_and_refracted_directions_are_of_length_1_to_one_rounding() {
    let (mut rays, mut worst) = (0, 0.0_f64);
    for scene in scenes() {
        let recorded = record(&scene);
        for kind in [RayKind::Primary, RayKind::Reflect, RayKind::Refract] {
            for row in &recorded.of(kind).rows {
                let [.., dx, dy, dz, _] = row.map(f64::from);
                worst = worst.max((DVec3::new(dx, dy, dz).length() - 1.0).abs());
                rays += 1;
            }
        }
    }
    assert!(rays > 30_000, "{rays}");
    assert!(worst <= 1.01 * U, "{} of 2^-24", worst / U);
}
