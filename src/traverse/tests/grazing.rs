//! Faces seen nearly edge-on: their t is uncertain by more than their boxes are, and whether they or something just behind
//! is nearest must not depend on whose box is met first.

use super::Random;
use super::brute_force::Query;
use super::rays::{By, Walk, assert_same_as_all};
use super::scenes::scene_of;
use crate::kernel::tests::sight::Sight;
use crate::kernel::tests::single;
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::scene::{Geometry, MaterialId};
use glam::{DVec3, Vec3};

fn add_face(geometry: &mut Geometry, corners: &[Vec3]) {
    if let [a, b, c] = corners {
        let first = geometry.add_vertices([*a, *b, *c]).unwrap();
        geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
    } else {
        geometry.add_polygon(corners, None, MaterialId(0)).unwrap();
    }
}

/// A ray, a face that it runs nearly along and meets near a corner, and a smaller one that it meets head-on some way before
/// or behind.
fn ray_and_faces(random: &mut Random, sides: usize) -> (Geometry, DVec3, DVec3) {
    let corner = 0.5 * random.vector();
    let eye = corner + random.vector();
    let away = (corner - eye).normalize();
    let side = random.vector().reject_from(away).normalize();
    let tilt = random.between(-24.0, -2.0).exp2();
    let along = away + tilt * away.cross(side);
    let size = random.between(-6.0, -1.0).exp2();
    let first = random.between(-2.0, 2.0);
    let mut corners = vec![DVec3::ZERO];
    corners.extend((1..sides).map(|at| {
        let share = at as f64 / sides as f64;
        side * (0.2 + share) + along * (first + random.between(-0.3, 0.3) + 2.0 * share * random.unit())
    }));
    let corners: Vec<Vec3> = corners.into_iter().map(|at| (corner + size * at).as_vec3()).collect();
    let between = corners[1].as_dvec3().lerp(corners[sides - 1].as_dvec3(), random.unit());
    let target = corners[0].as_dvec3().lerp(between, random.between(-24.0, -4.0).exp2());

    let off = random.between(-20.0, -6.0).exp2() * if random.chance(0.5) { -1.0 } else { 1.0 };
    let at = target + off * (target - eye);
    let x = 0.01 * away.any_orthonormal_vector();
    let y = away.cross(x);
    let mut geometry = Geometry::default();
    add_face(&mut geometry, &corners);
    add_face(&mut geometry, &[at + x, at - x + y, at - x - y].map(DVec3::as_vec3));
    (geometry, eye, target)
}

#[test]
fn what_is_nearest_does_not_depend_on_which_rays_walk_together() {
    let mut in_packets = 0;
    for seed in 0..6000 {
        let random = &mut Random::new(seed);
        let sides = 3 + random.below(3);
        let (geometry, eye, target) = ray_and_faces(random, sides);
        let scene = scene_of(geometry);
        let prepared = Prepared::new(&scene).unwrap();
        let factor = f64::from(prepared.scale.factor());
        let origin = (eye * factor).as_vec3().as_dvec3();
        let ray = Query::new(Sight::new(origin, target * factor - origin));
        let (t, id) = ray.closest::<false>(&prepared.hierarchy);

        // Beside others like it, whose bounds let boxes be entered earlier, and beside one that keeps them all apart.
        let mut rays: Vec<Query> = vec![ray; 64];
        for other in &mut rays[1..] {
            other.sight.origin = other.sight.origin.map(|at| at + single(random.between(-0.1, 0.1)));
        }
        for last_turns_back in [false, true] {
            if last_turns_back {
                rays[63].sight.direction = rays[63].sight.direction.map(|component| -component);
            }
            for width in Width::ALL {
                let walk = Walk {
                    hierarchy: &prepared.hierarchy,
                    rays: &rays,
                    departing: false,
                    any: false,
                    by: By::Rows,
                };
                let found = width.run(walk);
                assert_eq!((found.t[0], found.id[0]), (t, id), "seed {seed}, {width:?}, {:?}", found.counts);
                in_packets += found.counts.in_packets;
            }
        }
        if seed % 16 == 0 {
            assert_same_as_all(&prepared, &rays, false);
        }
    }
    assert_eq!(in_packets, 6000 * 4 * 64);
}

/// Within the plane of a face, on points of a grid so that its normal may be exactly across the ray, what the plane says of t is
/// anything between the face's ends: one t all the same, with a sphere between them in front of it or behind it for all.
#[test]
fn rays_within_the_plane_of_a_face_meet_it_at_one_t() {
    let steps = [DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0)];
    let mut edge_on = 0;
    for seed in 0..2000 {
        let random = &mut Random::new(seed);
        let in_plane = |random: &mut Random, spread: f64| {
            let step = |random: &mut Random| (random.between(-spread, spread)).round() / 4.0;
            step(random) * steps[0] + step(random) * steps[1]
        };
        let origin = 2.0 * in_plane(random, 6.0);
        let target = in_plane(random, 4.0);
        if origin == target {
            continue;
        }
        let mut geometry = Geometry::default();
        let size = random.between(0.2, 0.9);
        geometry.add_sphere(target.as_vec3(), single(0.1 * size), MaterialId(0)).unwrap();
        let count = 4 + random.below(5);
        let corners: Vec<Vec3> = (0..count)
            .map(|at| {
                let (sin, cos) = (std::f64::consts::TAU * at as f64 / count as f64).sin_cos();
                let size = random.between(0.3, 1.0);
                let [cos, sin] = [cos, sin].map(|side| (size * side * 4.0).round() / 4.0);
                (target + cos * steps[0] + sin * steps[1]).as_vec3()
            })
            .collect();
        if geometry.add_polygon(&corners, None, MaterialId(0)).is_err() {
            continue;
        }
        let scene = scene_of(geometry);
        let prepared = Prepared::new(&scene).unwrap();
        let factor = f64::from(prepared.scale.factor());
        let ray = Query::new(Sight::new(origin * factor, (target - origin) * factor));
        edge_on += usize::from(ray.hits::<false>(&prepared.hierarchy).len() == 2);
        for count in [1, 8, 64] {
            assert_same_as_all(&prepared, &vec![ray; count], false);
        }
    }
    assert!(edge_on > 100, "{edge_on} rays meet both");
}
