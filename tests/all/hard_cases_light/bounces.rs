//! Rays that go on for fifty bounces.

use super::{Place, aimed, each_ray, engines, length, rounding_of};
use crate::support::scene;
use glam::Vec3;
use wavelane::scene::Scene;

const BOUNCES: usize = 50;

/// Follows the one ray that there is: all of it goes on, and its direction stays a unit vector to 4 roundings.
#[track_caller]
fn goes_on(name: &str, scene: &Scene, eye: Vec3, target: Vec3) {
    for engine in engines() {
        let ray = aimed(scene, engine, eye, target);
        let mut deepest = 0;
        each_ray(&ray, 0, &mut |ray, depth| {
            let off = (length(ray.direction) - 1.0).abs() / rounding_of(engine);
            assert!(off <= 4.0, "{name}, depth {depth}: {off} roundings, {engine:?}");
            assert_eq!(ray.weight, [1.0; 3], "{name}, depth {depth}, {engine:?}");
            assert!(ray.hit.is_some() && ray.refract.is_none(), "{name}, depth {depth}, {engine:?}: {ray:?}");
            deepest = depth;
        });
        assert_eq!(deepest, BOUNCES, "{name}, {engine:?}");
    }
}

fn of(material: &str, shapes: &str) -> Scene {
    scene(&format!(
        "[image]\nsize = [1, 1]\nbackground = 1\n[render]\nmax_depth = {BOUNCES}\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
         up = [0, 1, 0]\nfov = 1\n[material.m]\n{material}\n{shapes}"
    ))
}

/// Case 49: Fifty bounces between two facing mirrors.
#[test]
fn case_49_fifty_bounces_between_facing_mirrors() {
    for kind in ["triangle", "polygon"] {
        for turned in [false, true] {
            let place = Place { turned, offset: 3.0 };
            let mirror = |z: f32| {
                let corners = [[-60.0, -60.0], [60.0, -60.0], [0.0, 60.0]].map(|[x, y]| Vec3::new(x, y, z));
                place.face(kind, &corners, "m")
            };
            let scene = of("mirror = 1", &(mirror(0.0) + &mirror(1.0)));
            for lean in [0.0, 0.1, 0.25] {
                let (eye, target) =
                    (Vec3::new(-20.0 * lean, 0.0, 0.5), Vec3::new(-19.0 * lean, 0.1 * lean, 0.0));
                goes_on(kind, &scene, place.point(eye), place.point(target));
            }
        }
    }
}

/// Case 49: Fifty total internal reflections along a fibre and around a ball: seen from inside, nothing gets out.
#[test]
fn case_49_fifty_total_internal_reflections_in_a_fibre() {
    for kind in ["triangle", "polygon"] {
        for turned in [false, true] {
            let place = Place { turned, offset: 3.0 };
            let corner = |index: usize| {
                let side = |bit: usize| if index >> bit & 1 == 1 { 0.05 } else { -0.05 };
                Vec3::new(side(0), side(1), if index & 4 == 4 { 30.0 } else { 0.0 })
            };
            let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            let faces = faces.map(|face| {
                let [a, b, c, d] = face.map(corner);
                match kind {
                    "triangle" => place.face(kind, &[a, b, c], "m") + &place.face(kind, &[a, c, d], "m"),
                    _ => place.face(kind, &[a, b, c, d], "m"),
                }
            });
            for material in ["ior = 1.5", "ior = 1.5\nfresnel = false"] {
                let scene = of(material, &faces.concat());
                let eye = Vec3::new(0.01, -0.02, 0.1);
                for across in [[0.31, 0.23], [0.52, 0.013], [-0.2, 0.5]] {
                    let target = eye + Vec3::new(across[0], across[1], 0.9);
                    goes_on(kind, &scene, place.point(eye), place.point(target));
                }
            }
        }
    }
    let ball = of("ior = 1.5", "[[sphere]]\ncenter = [0.1, -0.2, 0.3]\nradius = 1.25\nmaterial = \"m\"\n");
    for lean in [0.0, 0.3] {
        // At 0.9 of the radius, across it: an angle of incidence of 60° and more.
        goes_on("ball", &ball, Vec3::new(0.1, -0.2, 0.3 + 1.125), Vec3::new(1.1, 0.5, 0.3 + 1.125 + lean));
    }
}
