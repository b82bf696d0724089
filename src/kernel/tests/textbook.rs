//! The formulas that the engine does not use find what it finds where any formula does, and what they promise beyond that.

use super::sight::{self, Sight};
use super::single;
use crate::kernel::sphere;
use crate::kernel::textbook::{compensated_sphere, moller_trumbore, quadratic};
use crate::kernel::triangle;
use crate::lanes::Vector;
use glam::DVec3;

type Answer = Option<f32>;

fn answer((t, hit): (f32, bool)) -> Answer {
    hit.then_some(t)
}

/// By the engine's formula, the quadratic one and the compensated one.
fn of_sphere(ray: Sight, center: [f32; 3], radius: f32) -> [Answer; 3] {
    let (line, center) = (sight::line::<f32>(&[ray]), Vector::splat(center));
    [
        answer(sphere::meet(&line, center, radius * radius, 0.0).nearest(0.0)),
        answer(quadratic::nearest(&line, center, radius, 0.0)),
        answer(compensated_sphere::nearest(&line, center, radius, 0.0)),
    ]
}

/// Rays from before, inside and behind the origin, of several lengths, through points of a grid.
fn rays() -> impl Iterator<Item = Sight> {
    let steps = || (-6..=6_i8).map(|step| f64::from(step) * 0.31 + 0.013);
    let grid = steps().flat_map(move |x| steps().map(move |y| [x, y]));
    grid.flat_map(|[x, y]| {
        [-5.0, 0.1, 5.0].into_iter().flat_map(move |z| {
            [0.5, 1.0, 3.0].map(move |length| {
                let toward = DVec3::new(0.3 * y, -0.2 * x, 0.4);
                Sight::new(DVec3::new(x, y, z), length * (toward - DVec3::Z * 2.0))
            })
        })
    })
}

#[test]
fn formulas_for_a_sphere_agree_where_none_loses_digits() {
    let (mut hits, mut misses) = (0, 0);
    for ray in rays() {
        let [engines, others @ ..] = of_sphere(ray, [0.1, 0.2, -0.1], 1.25);
        for other in others {
            match (engines, other) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-4, "{a} and {b} for {ray:?}"),
                (a, b) => assert_eq!(a, b, "{ray:?}"),
            }
        }
        *(if engines.is_some() { &mut hits } else { &mut misses }) += 1;
    }
    assert!(hits > 100 && misses > 100, "{hits} hits, {misses} misses");
}

#[test]
fn near_a_large_sphere_the_compensated_root_keeps_its_digits() {
    let mut engines_worst = 0.0_f64;
    for radius in [1e2, 1e4, 1e6] {
        for height in [0.01, 1.0, 10.0] {
            for tilt in [0.0, 0.3, 0.8] {
                let ray = Sight::new(DVec3::new(0.3, height, -5.0), DVec3::new(0.6 * tilt, -1.0, 0.8 * tilt));
                let center = [0.0, single(-radius), 0.0];
                // (|o − c| − r)(|o − c| + r) over the larger root: right to 2⁻⁵³·r/h of itself.
                let from_center = ray.o() - DVec3::from(center.map(f64::from));
                let (a, b) = (ray.d().length_squared(), from_center.dot(ray.d()));
                let distance = from_center.length();
                let product = (distance - radius) * (distance + radius);
                let expected = product / (-b + (b * b - a * product).sqrt());
                let off = |found: Answer| (f64::from(found.unwrap_or(0.0)) - expected).abs() / expected;
                let [engines, _, compensated] = of_sphere(ray, center, single(radius));
                assert!(off(compensated) < 1e-6, "{compensated:?} for {expected}, radius {radius}");
                engines_worst = engines_worst.max(off(engines));
            }
        }
    }
    assert!(engines_worst > 0.5, "the cases are hard: {engines_worst}");
}

#[test]
fn moller_and_trumbore_s_test_agrees_with_the_engine_s_away_from_edges() {
    let (mut hits, mut misses) = (0, 0);
    let corners = [[-1.1, -0.9, 0.2], [1.3, -0.7, -0.3], [0.1, 1.4, 0.4]];
    for corners in [corners, [corners[1], corners[0], corners[2]]] {
        for ray in rays() {
            let (space, axes) = (sight::space::<f32>(&[ray]), ray.axes());
            let meeting = triangle::meet(&space, corners.map(|corner| axes.map(|axis| corner[axis])));
            let t = meeting.t(&space);
            let engines = answer((t, meeting.inside(0.0) && t > 0.0));
            let line = [ray.origin, ray.direction].map(Vector::splat);
            let found = answer(moller_trumbore::nearest(line, corners.map(Vector::splat), 0.0, 1.0));
            match (engines, found) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-5, "{a} and {b} for {ray:?}"),
                (a, b) => assert_eq!(a, b, "{ray:?}"),
            }
            *(if engines.is_some() { &mut hits } else { &mut misses }) += 1;
        }
    }
    assert!(hits > 100 && misses > 100, "{hits} hits, {misses} misses");
}

#[test]
fn a_triangle_seen_edge_on_is_missed() {
    let line = [[0.0, 0.25, 5.0], [0.0, 0.0, -1.0]].map(Vector::splat);
    let corners = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::splat);
    assert_eq!(answer(moller_trumbore::nearest(line, corners, 0.0_f32, 1.0)), None);
}
