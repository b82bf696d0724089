//! What a tracer does that starts its rays at origin + t·direction in f32 and leaves out hits up to some ε: so that it is known
//! what the campaign's zeros are worth.

use super::grid::icosphere;
use crate::random::Random;
use glam::{DVec3, Vec3};

/// Rays of a cell of the table.
const RAYS: u32 = 40_000;

/// From where on hits count, and whether the primitive that a ray leaves is left out.
#[derive(Clone, Copy, Debug)]
struct Rule {
    epsilon: f32,
    skips_own: bool,
}

const RULES: [Rule; 4] = [
    Rule { epsilon: 0.0, skips_own: false },
    Rule { epsilon: 1e-4, skips_own: false },
    Rule { epsilon: 1e-3, skips_own: false },
    Rule { epsilon: 0.0, skips_own: true },
];

#[derive(Clone, Copy)]
struct Ray {
    origin: Vec3,
    direction: Vec3,
}

enum Shape {
    Sphere { center: Vec3, radius: f32 },
    Triangle([Vec3; 3]),
}

impl Shape {
    /// t of the nearest hit beyond ε, as textbooks have it: the quadratic formula; Möller and Trumbore.
    fn meet(&self, ray: &Ray, epsilon: f32) -> Option<f32> {
        let beyond = |t: f32| (t > epsilon).then_some(t);
        match self {
            Self::Sphere { center, radius } => {
                let from_center = ray.origin - center;
                let (a, b) = (ray.direction.length_squared(), 2.0 * from_center.dot(ray.direction));
                let discriminant = b * b - 4.0 * a * (from_center.length_squared() - radius * radius);
                if discriminant < 0.0 {
                    return None;
                }
                let root = discriminant.sqrt();
                beyond((-b - root) / (2.0 * a)).or(beyond((-b + root) / (2.0 * a)))
            }
            Self::Triangle([first, second, third]) => {
                let (one, two) = (second - first, third - first);
                let across = ray.direction.cross(two);
                let inverse = 1.0 / one.dot(across);
                let from_first = ray.origin - first;
                let u = from_first.dot(across) * inverse;
                let along = from_first.cross(one);
                let v = ray.direction.dot(along) * inverse;
                let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
                if is_inside { beyond(two.dot(along) * inverse) } else { None }
            }
        }
    }

    fn normal(&self, point: Vec3) -> Vec3 {
        match self {
            Self::Sphere { center, .. } => (point - center).normalize(),
            Self::Triangle([first, second, third]) => (second - first).cross(third - first).normalize(),
        }
    }
}

fn nearest(shapes: &[Shape], ray: &Ray, epsilon: f32, skipped: Option<usize>) -> Option<(f32, usize)> {
    let hits = shapes.iter().enumerate().filter(|(index, _)| Some(*index) != skipped);
    hits.filter_map(|(index, shape)| Some((shape.meet(ray, epsilon)?, index)))
        .min_by(|(one, _), (other, _)| one.total_cmp(other))
}

/// A convex body of a size, some sizes from the origin.
#[derive(Clone, Copy)]
struct Place {
    size: f64,
    away: f64,
}

const PLACES: [(&str, Place); 4] = [
    ("size 1 at the origin", Place { size: 1.0, away: 0.0 }),
    ("size 1, 1024 away", Place { size: 1.0, away: 1024.0 }),
    ("size 2^-12 at the origin", Place { size: 1.0 / 4096.0, away: 0.0 }),
    ("size 2^12 at the origin", Place { size: 4096.0, away: 0.0 }),
];

impl Place {
    fn center(self) -> DVec3 {
        DVec3::new(0.6, -0.64, 0.48) * self.away * self.size
    }

    fn ball(self) -> Vec<Shape> {
        vec![Shape::Sphere { center: self.center().as_vec3(), radius: (0.5 * self.size) as f32 }]
    }

    fn mesh(self, random: &mut Random) -> Vec<Shape> {
        let steps = f64::from(1 << 12);
        let corner =
            |corner: glam::I64Vec3| (corner.as_dvec3() * (self.size / steps) + self.center()).as_vec3();
        let faces = icosphere(steps, 1, random);
        faces
            .iter()
            .map(|face| Shape::Triangle([corner(face[0]), corner(face[1]), corner(face[2])]))
            .collect()
    }
}

/// Of a million mirrored rays that leave a convex body, those that meet it again.
fn self_hits(shapes: &[Shape], place: Place, rule: Rule, random: &mut Random) -> f64 {
    let (mut rays, mut wrong) = (0_u32, 0_u32);
    while rays < RAYS {
        let eye = place.center() + random.direction() * place.size * random.log_between(2.0, 20.0);
        let aim = place.center() + random.direction() * place.size * 0.4 * random.unit();
        let ray = Ray { origin: eye.as_vec3(), direction: (aim - eye).normalize().as_vec3() };
        let Some((t, index)) = nearest(shapes, &ray, 0.0, None) else { continue };
        let point = ray.origin + ray.direction * t;
        let normal = shapes[index].normal(point);
        let direction = ray.direction - normal * (2.0 * ray.direction.dot(normal));
        if direction.dot(normal) <= 0.0 {
            continue;
        }
        rays += 1;
        let mirrored = Ray { origin: point, direction };
        let skipped = rule.skips_own.then_some(index);
        wrong += u32::from(nearest(shapes, &mirrored, rule.epsilon, skipped).is_some());
    }
    f64::from(wrong) / f64::from(rays) * 1e6
}

/// Of a million rays that leave a ball downward, next to where it stands on the ground, those that do not meet the ground.
fn lost_contacts(place: Place, rule: Rule, random: &mut Random) -> f64 {
    let radius = 0.5 * place.size;
    let contact = place.center();
    let mut wrong = 0_u32;
    for _ in 0..RAYS {
        let angle = random.log_between(1e-3, 1.0);
        let outward = DVec3::new(angle.sin(), 0.0, -angle.cos());
        let start = (contact + DVec3::Z * radius + outward * radius).as_vec3();
        let down = loop {
            let direction = random.direction();
            if direction.z < -1e-2 && direction.dot(outward) > 0.0 {
                break direction.as_vec3();
            }
        };
        let t = (contact.z as f32 - start.z) / down.z;
        // A start that rounding has put into the ground is none of this rule's.
        wrong += u32::from(start.z > contact.z as f32 && t <= rule.epsilon);
    }
    f64::from(wrong) / f64::from(RAYS) * 1e6
}

#[test]
fn an_epsilon_does_not_do_what_the_engine_does() {
    let mut random = Random::new(&[7]);
    println!(
        "\n| a million rays | rule | self-hits of a sphere | of 80 triangles | contacts lost |\n|---|---|---|---|---|"
    );
    let mut worst = [0.0_f64; 2];
    for (name, place) in PLACES {
        let (ball, mesh) = (place.ball(), place.mesh(&mut random));
        for rule in RULES {
            let of_ball = self_hits(&ball, place, rule, &mut random);
            let of_mesh = self_hits(&mesh, place, rule, &mut random);
            let lost = lost_contacts(place, rule, &mut random);
            let own = if rule.skips_own { ", without what it leaves" } else { "" };
            println!("| {name} | t > {:e}{own} | {of_ball:.0} | {of_mesh:.0} | {lost:.0} |", rule.epsilon);
            let [hits, contacts] = &mut worst;
            if rule.epsilon > 0.0 {
                (*hits, *contacts) = (hits.max(of_ball).max(of_mesh), contacts.max(lost));
            } else if !rule.skips_own {
                assert!(of_ball > 1e4 && of_mesh > 1e4, "without any rule self-hits are common: {name}");
            }
        }
    }
    assert!(
        worst.iter().all(|&worst| worst > 1e4),
        "an epsilon is too small here and too large there: {worst:?}"
    );
}
