//! The sphereflake: a sphere carries nine of a third of its radius, each of which carries nine.
//!
//! Nine of the twelve directions in which spheres touch in the densest packing: six around, three above. They are 60°
//! apart. No sphere meets another but where it sits: a flake reaches 1 + 2/3 + 2/9 + … = 2 radii from its centre, so the
//! flakes that two neighbours carry, 4/3 apart, just touch in the limit. The root rests on the ground.

use super::rounded;
use crate::scene::{
    Camera, Geometry, GeometryProblem, ImageSettings, Light, Material, MaterialId, Projection,
    RenderSettings, Rgb, Scene,
};
use glam::{DVec3, Vec3};

/// Radius of the root, which the scene is built around.
const RADIUS: f64 = 0.5;
/// √3/2, √(1/3) and √(2/3).
const SIN_60: f64 = 0.866_025_403_784_438_6;
const SQRT_1_3: f64 = 0.577_350_269_189_625_8;
const SQRT_2_3: f64 = 0.816_496_580_927_726;

/// Unit directions from a sphere to those that it carries, along its `side`, `axis` × `side` and `axis`.
const DIRECTIONS: [[f64; 3]; 9] = [
    [0.5, SQRT_1_3 / 2.0, SQRT_2_3],
    [-0.5, SQRT_1_3 / 2.0, SQRT_2_3],
    [0.0, -SQRT_1_3, SQRT_2_3],
    [1.0, 0.0, 0.0],
    [-0.5, SIN_60, 0.0],
    [-0.5, -SIN_60, 0.0],
    [0.5, SIN_60, 0.0],
    [-1.0, 0.0, 0.0],
    [0.5, -SIN_60, 0.0],
];

struct Ball {
    center: DVec3,
    radius: f64,
    /// Unit, away from the ball that carries this one.
    axis: DVec3,
    /// Unit, at right angles to `axis`.
    side: DVec3,
}

impl Ball {
    fn carried(&self, direction: [f64; 3]) -> Self {
        let [x, y, z] = direction;
        let axis = (x * self.side + y * self.axis.cross(self.side) + z * self.axis).normalize();
        let radius = self.radius / 3.0;
        let side = (self.axis - axis * axis.dot(self.axis)).normalize();
        Self { center: self.center + axis * (self.radius + radius), radius, axis, side }
    }
}

/// A ground and `size` − 1 spheres, one at least.
pub(super) fn scene(size: usize) -> Result<Scene, GeometryProblem> {
    // A material for each generation; the last is also that of all younger ones.
    let [gold, silver, copper, steel] =
        [[0.55, 0.38, 0.12], [0.3, 0.33, 0.36], [0.5, 0.2, 0.1], [0.16, 0.26, 0.42]].map(Rgb::from_array);
    let ball = |diffuse| Material {
        diffuse,
        specular: Rgb::splat(0.5),
        shininess: 60.0,
        mirror: Rgb::splat(0.5),
        ..Material::default()
    };
    let ground = Material { diffuse: Rgb::new(0.62, 0.56, 0.46), ..Material::default() };
    let materials = vec![ball(gold), ball(silver), ball(copper), ball(steel), ground];

    let mut geometry = Geometry::default();
    add_flake(&mut geometry, size.saturating_sub(1).max(1))?;
    let (far, level) = (12.0, -RADIUS);
    let corners = [[far, far], [-far, far], [-far, -far], [far, -far]];
    let corners = corners.map(|[x, y]| DVec3::new(x, y, level).as_vec3());
    geometry.add_polygon(&corners, None, MaterialId(4))?;

    let light = |position: [f32; 3]| Light::Point { position: position.into(), intensity: Rgb::splat(0.58) };
    Ok(Scene {
        image: ImageSettings { width: 1024, height: 1024, background: Rgb::new(0.3, 0.52, 0.82) },
        render: RenderSettings { max_depth: 4, ..RenderSettings::default() },
        camera: Camera {
            eye: Vec3::new(2.0, -1.6, 1.35),
            target: Vec3::new(0.0, 0.0, 0.06),
            up: Vec3::Z,
            projection: Projection::PerspectiveAngle { vertical_degrees: 42.0 },
        },
        ambient: Rgb::ZERO,
        lights: [[4.0, -1.0, 3.0], [-1.0, -4.0, 4.5], [2.0, 4.0, 5.0]].map(light).to_vec(),
        materials,
        geometry,
    })
}

/// Adds `count` spheres, generation by generation.
fn add_flake(geometry: &mut Geometry, count: usize) -> Result<(), GeometryProblem> {
    let mut left = count;
    let mut generation = vec![Ball { center: DVec3::ZERO, radius: RADIUS, axis: DVec3::Z, side: DVec3::X }];
    for material in [0, 1, 2, 3].into_iter().chain(std::iter::repeat(3)).map(MaterialId) {
        for ball in &generation {
            geometry.add_sphere(ball.center.as_vec3(), rounded(ball.radius), material)?;
        }
        left -= generation.len();
        if left == 0 {
            break;
        }
        // Every ball gets its first before one gets its second, so a generation that is not full is thin, not one-sided.
        let carried = DIRECTIONS
            .iter()
            .flat_map(|&direction| generation.iter().map(move |ball| ball.carried(direction)));
        generation = carried.take(left).collect();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Sphere;

    #[test]
    fn every_sphere_sits_on_one_and_meets_no_other() {
        let mut geometry = Geometry::default();
        add_flake(&mut geometry, 1 + 9 + 81 + 300).unwrap();
        let gap = |a: &Sphere, b: &Sphere| {
            let between = (a.center.as_dvec3() - b.center.as_dvec3()).length();
            between - f64::from(a.radius) - f64::from(b.radius)
        };
        for (index, sphere) in geometry.spheres.iter().enumerate().skip(1) {
            let gaps = geometry.spheres[..index].iter().map(|other| gap(sphere, other));
            let touched = gaps.clone().filter(|gap| gap.abs() < 1e-6).count();
            assert_eq!(touched, 1, "sphere {index} sits on one");
            assert!(gaps.clone().all(|gap| gap > -1e-6), "sphere {index} cuts into none");
            let bottom = f64::from(sphere.center.z) - f64::from(sphere.radius);
            assert!(bottom > -RADIUS, "sphere {index} is above the ground");
        }
    }

    #[test]
    fn a_generation_that_is_not_full_is_spread_over_all_that_carry() {
        let mut geometry = Geometry::default();
        add_flake(&mut geometry, 1 + 9 + 9 * 4).unwrap();
        for carrier in &geometry.spheres[1..10] {
            let reach = 1.01 * carrier.radius * 4.0 / 3.0;
            let carried = geometry.spheres[10..].iter();
            assert_eq!(carried.filter(|ball| ball.center.distance(carrier.center) < reach).count(), 4);
        }
    }
}
