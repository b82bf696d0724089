//! Hard cases of optics and of secondary rays, a test a case, numbered and named as a survey of the literature and of other
//! tracers has them. u is 2⁻²⁴, half the distance from 1 to the next f32.
//!
//! Each is asked of the reference and of the wavefront engine at every width. Formulas alone are tested beside them, in
//! `src/wavefront/optics.rs` and `src/reference/optics.rs`.

mod bounces;
mod contact;
mod corners;
mod lamps;
mod optics;
mod scale;
mod secondary;
mod solids;

use glam::{DVec3, Quat, Vec3};
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::ray_tree::{PixelTree, RayTree};
use wavelane::render::{Engine, pixel_tree};
use wavelane::scene::{Projection, Scene};

/// Rounding of f32.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The reference, and the wavefront engine at every width.
fn engines() -> impl Iterator<Item = Engine> {
    [Engine::Reference].into_iter().chain(Width::ALL.map(Engine::wavefront))
}

/// 2⁻²⁴ for an engine that keeps rays in f32, 2⁻⁵³ for the reference.
fn rounding_of(engine: Engine) -> f64 {
    if engine == Engine::Reference { f64::EPSILON / 2.0 } else { U }
}

fn tree(scene: &Scene, engine: Engine, place: [u32; 2]) -> PixelTree {
    pixel_tree(scene, engine, place, &AtomicBool::new(false)).unwrap()
}

/// The tree of a single ray from an eye to a target, as near as f32 has them.
fn aimed(scene: &Scene, engine: Engine, eye: Vec3, target: Vec3) -> RayTree {
    let mut scene = scene.clone();
    (scene.image.width, scene.image.height) = (1, 1);
    (scene.camera.eye, scene.camera.target) = (eye, target);
    let along = (target - eye).abs();
    // Any direction that is not nearly the line of sight.
    scene.camera.up = if along.x < along.z { Vec3::X } else { Vec3::Z };
    scene.camera.projection = Projection::PerspectiveAngle { vertical_degrees: 1.0 };
    tree(&scene, engine, [0, 0]).samples.remove(0)
}

/// Calls a check with a ray and all its descendants, and with how deep they are.
fn each_ray(ray: &RayTree, depth: usize, check: &mut impl FnMut(&RayTree, usize)) {
    check(ray, depth);
    for child in [&ray.reflect, &ray.refract].into_iter().flatten() {
        each_ray(child, depth + 1, check);
    }
}

fn length(vector: [f64; 3]) -> f64 {
    DVec3::from(vector).length()
}

/// Where a case lies: turned by nothing simple, or not at all, and moved.
#[derive(Clone, Copy, Debug)]
struct Place {
    turned: bool,
    offset: f32,
}

impl Place {
    /// A point of a case, rounded to f32.
    fn point(self, point: Vec3) -> Vec3 {
        self.direction(point) + self.offset * Vec3::new(1.0, -0.75, 0.625)
    }

    fn direction(self, direction: Vec3) -> Vec3 {
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.37, 1.13, 0.71);
        if self.turned { turn * direction } else { direction }
    }

    /// As a scene file has it.
    fn text(self, point: Vec3) -> String {
        format!("{:?}", self.point(point).to_array())
    }

    /// A face of a scene file.
    fn face(self, kind: &str, corners: &[Vec3], material: &str) -> String {
        let corners: Vec<String> = corners.iter().map(|&corner| self.text(corner)).collect();
        format!("[[{kind}]]\nvertices = [{}]\nmaterial = \"{material}\"\n", corners.join(", "))
    }
}
