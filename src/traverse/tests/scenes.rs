//! Scenes in which everything meets everything: a coarse grid makes flat boxes, ties and rays within faces common.

use super::Random;
use crate::scene::{Geometry, Material, MaterialId, Scene};
use glam::{DVec3, Vec3};

/// Steps of the grid along an axis.
const STEPS: usize = 8;

/// A point of the grid, or near one.
pub(super) fn grid_point(random: &mut Random) -> DVec3 {
    let point = DVec3::from([(); 3].map(|()| (random.below(STEPS + 1) as f64 - STEPS as f64 / 2.0) / 4.0));
    if random.chance(0.8) { point } else { point + 0.25 * random.vector() }
}

/// Opaque, and what casts no shadow.
const MATERIALS: [MaterialId; 2] = [MaterialId(0), MaterialId(1)];

pub(super) fn scene_of(geometry: Geometry) -> Scene {
    let shadowless = Material { casts_shadow: false, ..Material::grey() };
    Scene::unlit(geometry, vec![Material::grey(), shadowless])
}

/// Spheres, triangles and polygons, some of them twice.
pub(super) fn mixed(random: &mut Random, count: usize, shadowless: f64) -> Scene {
    let mut geometry = Geometry::default();
    while geometry.primitive_count() < count {
        let material = MATERIALS[usize::from(random.chance(shadowless))];
        let times = if random.chance(0.15) { 2 } else { 1 };
        match random.below(3) {
            0 => {
                let (center, steps) = (grid_point(random).as_vec3(), 1 + random.below(3));
                for _ in 0..times {
                    geometry.add_sphere(center, steps as f32 / 8.0, material).unwrap();
                }
            }
            1 => {
                let corners = [(); 3].map(|()| grid_point(random).as_vec3());
                for _ in 0..times {
                    let first = geometry.add_vertices(corners).unwrap();
                    geometry.add_triangle([first, first + 1, first + 2], None, material).unwrap();
                }
            }
            _ => {
                let corners = polygon(random);
                for _ in 0..times {
                    // What is not planar to within the rounding of its corners is none.
                    let _ = geometry.add_polygon(&corners, None, material);
                }
            }
        }
    }
    scene_of(geometry)
}

/// Corners of an outline in a coordinate plane, or in any through the grid's points; often concave.
fn polygon(random: &mut Random) -> Vec<Vec3> {
    let center = grid_point(random);
    let sides = [[DVec3::X, DVec3::Y], [DVec3::Y, DVec3::Z], [DVec3::Z, DVec3::X]];
    let [x, y] = match random.below(5) {
        at @ 0..3 => sides[at],
        3 => [DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0)],
        _ => [random.vector(), random.vector()],
    };
    let count = 3 + random.below(8);
    let corner = |at: usize, size: f64| {
        let (sin, cos) = (std::f64::consts::TAU * at as f64 / count as f64).sin_cos();
        // On the grid where the plane is.
        let [cos, sin] = [cos, sin].map(|side| (size * side * 4.0).round() / 8.0);
        (center + cos * x + sin * y).as_vec3()
    };
    (0..count).map(|at| corner(at, random.between(0.3, 1.0))).collect()
}
