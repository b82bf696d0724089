//! Balls of every size on a chequered ground: glass, hollow glass, and mirrors.
//!
//! The ground is divided into four, and each part again; on the way one part in four is left whole and carries a ball, so
//! that there are balls of all sizes, and a larger scene is the same with more of the smaller ones. A hollow ball is a
//! bubble of air in glass: rays that leave the glass at a flat angle are reflected totally, which they never are in a ball
//! that they entered from outside.

use super::{is_chosen, rounded};
use crate::random::random_unit;
use crate::scene::{
    Camera, Dielectric, Fresnel, Geometry, GeometryProblem, ImageSettings, Light, Material, MaterialId,
    Projection, RenderSettings, Rgb, Scene,
};
use glam::{DVec3, Vec3};

/// Half the side of the ground.
const HALF: f64 = 2.0;
/// Radius of a ball, of a part's side.
const RADIUS: f64 = 0.46;
/// Radius of a bubble, of its ball's.
const BUBBLE: f64 = 0.82;

/// A square of the ground: one of 2^level × 2^level.
#[derive(Clone, Copy)]
struct Part {
    x: u32,
    y: u32,
    level: u32,
}

impl Part {
    fn divided(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| Self {
            x: 2 * self.x + x,
            y: 2 * self.y + y,
            level: self.level + 1,
        })
    }

    fn random(self, dimension: u32) -> f64 {
        random_unit([self.level, self.x, self.y, dimension])
    }

    fn is_left_whole(self) -> bool {
        self.level >= 2 && self.random(0) < 0.25
    }
}

// In the order of `materials`.
const CLEAR: MaterialId = MaterialId(0);
const AMBER: MaterialId = MaterialId(1);
const TEAL: MaterialId = MaterialId(2);
const AIR: MaterialId = MaterialId(3);
const MIRROR: MaterialId = MaterialId(4);
const DARK: MaterialId = MaterialId(5);
const LIGHT: MaterialId = MaterialId(6);

/// An eighth of the primitives are the squares of the ground, up to 16 × 16; all others are balls and bubbles.
pub(super) fn scene(size: usize) -> Result<Scene, GeometryProblem> {
    let side = (1..=16_u32).rev().find(|side| (8 * side * side) as usize <= size).unwrap_or(1);
    let mut geometry = Geometry::default();
    add_balls(&mut geometry, size.saturating_sub((side * side) as usize).max(1))?;
    add_ground(&mut geometry, side)?;
    Ok(Scene {
        image: ImageSettings { width: 1024, height: 1024, background: Rgb::new(0.45, 0.62, 0.85) },
        render: RenderSettings { max_depth: 10, min_weight: 1.0 / 512.0, ..RenderSettings::default() },
        camera: Camera {
            eye: Vec3::new(1.3, -4.9, 3.6),
            target: Vec3::new(-0.05, -0.1, 0.0),
            up: Vec3::Z,
            projection: Projection::PerspectiveAngle { vertical_degrees: 42.0 },
        },
        ambient: Rgb::splat(0.25),
        lights: vec![
            Light::Point { position: Vec3::new(-4.0, -3.0, 7.0), intensity: Rgb::splat(0.65) },
            Light::Directional { direction: Vec3::new(-0.6, 0.5, -1.0), intensity: Rgb::new(0.4, 0.37, 0.3) },
        ],
        materials: materials(),
        geometry,
    })
}

fn materials() -> Vec<Material> {
    let shiny = Material { specular: Rgb::splat(0.6), shininess: 300.0, ..Material::default() };
    let glass = |ior: f32, absorption: [f32; 3]| Material {
        dielectric: Some(Dielectric {
            ior,
            absorption: absorption.into(),
            transmission: Rgb::ONE,
            fresnel: Fresnel::Schlick,
        }),
        ..shiny
    };
    let ground = |diffuse: [f32; 3]| Material {
        ambient: diffuse.into(),
        diffuse: diffuse.into(),
        ..Material::default()
    };
    vec![
        glass(1.5, [0.06, 0.03, 0.05]),
        glass(1.5, [0.3, 0.9, 2.4]),
        glass(1.5, [1.9, 0.5, 0.6]),
        // Air, seen from the glass around it.
        Material { specular: Rgb::ZERO, ..glass(1.0 / 1.5, [0.0; 3]) },
        Material { mirror: Rgb::new(0.86, 0.83, 0.78), ..shiny },
        ground([0.16, 0.2, 0.26]),
        ground([0.78, 0.75, 0.68]),
    ]
}

fn add_balls(geometry: &mut Geometry, count: usize) -> Result<(), GeometryProblem> {
    // A bubble to every four balls.
    let bubbles = count / 5;
    let parts = parts(count - bubbles);
    let glass = parts.iter().filter(|&&part| material(part) != MIRROR).count();
    let mut glass_so_far = 0;
    for part in parts {
        let side = 2.0 * HALF / f64::from(1_u32 << part.level);
        let radius = RADIUS * side;
        let middle = |place: u32| -HALF + (f64::from(place) + 0.5) * side;
        let center = DVec3::new(middle(part.x), middle(part.y), radius).as_vec3();
        let material = material(part);
        geometry.add_sphere(center, rounded(radius), material)?;
        if material != MIRROR {
            if is_chosen(glass_so_far, bubbles.min(glass), glass) {
                geometry.add_sphere(center, rounded(BUBBLE * radius), AIR)?;
            }
            glass_so_far += 1;
        }
    }
    Ok(())
}

fn material(part: Part) -> MaterialId {
    match part.random(1) {
        kind if kind < 0.35 => CLEAR,
        kind if kind < 0.55 => AMBER,
        kind if kind < 0.7 => TEAL,
        _ => MIRROR,
    }
}

/// As many parts of the ground as asked, the large ones first.
fn parts(count: usize) -> Vec<Part> {
    let mut whole = Vec::new();
    let mut others = vec![Part { x: 0, y: 0, level: 0 }];
    loop {
        whole.extend(others.extract_if(.., |part| part.is_left_whole()));
        if whole.len() + 4 * others.len() > count {
            break;
        }
        others = others.into_iter().flat_map(Part::divided).collect();
    }
    // Some, evenly spread, are divided once more. Each division adds three, so up to two are too many.
    let (most, divisions) = (others.len(), (count - whole.len() - others.len()).div_ceil(3));
    for (index, part) in others.into_iter().enumerate() {
        if is_chosen(index, divisions, most) {
            whole.extend(part.divided());
        } else {
            whole.push(part);
        }
    }
    whole.truncate(count);
    whole
}

/// `side` × `side` squares, somewhat wider than the balls reach.
fn add_ground(geometry: &mut Geometry, side: u32) -> Result<(), GeometryProblem> {
    let edge = |place: u32| 1.1 * HALF * (2.0 * f64::from(place) / f64::from(side) - 1.0);
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
        let corners = corners.map(|corner| {
            let [x, y] = corner.map(edge);
            DVec3::new(x, y, 0.0).as_vec3()
        });
        let material = if (x + y) % 2 == 0 { DARK } else { LIGHT };
        geometry.add_polygon(&corners, None, material)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{PrimitiveId, Sphere};

    /// Balls, and the bubbles in them: a bubble follows its ball.
    fn balls_and_bubbles(size: usize) -> (Vec<Sphere>, Vec<[Sphere; 2]>) {
        let spheres = scene(size).unwrap().geometry.spheres;
        let bubbles = spheres.windows(2).filter(|pair| pair[1].material == AIR);
        let bubbles = bubbles.map(|pair| [pair[0], pair[1]]).collect();
        (spheres.into_iter().filter(|sphere| sphere.material != AIR).collect(), bubbles)
    }

    #[test]
    fn balls_rest_on_the_ground_apart_from_each_other() {
        let (balls, _) = balls_and_bubbles(1000);
        for (index, ball) in balls.iter().enumerate() {
            assert_eq!(ball.center.z, ball.radius);
            for other in &balls[..index] {
                assert!(
                    ball.center.distance(other.center) > ball.radius + other.radius,
                    "{ball:?}, {other:?}"
                );
            }
        }
    }

    #[test]
    fn a_bubble_is_inside_a_ball_of_glass() {
        let (balls, bubbles) = balls_and_bubbles(1000);
        assert_eq!(bubbles.len(), (bubbles.len() + balls.len()) / 5);
        for [ball, bubble] in bubbles {
            assert!(ball.material != MIRROR && ball.center == bubble.center && bubble.radius < ball.radius);
        }
    }

    #[test]
    fn there_are_as_many_parts_as_asked_and_none_twice() {
        for count in (1..100).chain([1000, 12_345]) {
            let mut parts: Vec<[u32; 3]> =
                parts(count).iter().map(|part| [part.level, part.x, part.y]).collect();
            parts.sort_unstable();
            parts.dedup();
            assert_eq!(parts.len(), count);
        }
    }

    #[test]
    fn a_larger_scene_keeps_the_large_balls() {
        let large = |size: usize| -> Vec<Sphere> {
            let (balls, _) = balls_and_bubbles(size);
            balls
                .into_iter()
                .filter(|ball| ball.radius > 0.1)
                .map(|ball| Sphere { id: PrimitiveId(0), ..ball })
                .collect()
        };
        assert!(large(1000).len() > 5);
        assert_eq!(large(1000), large(20_000));
    }
}
