//! What hides a lamp from close by.

use super::{Place, U, engines};
use crate::support::{render_with, scene};
use glam::Vec3;

/// What a lamp is close to.
#[derive(Clone, Copy, Debug)]
enum Wall {
    /// Parallel to the ground.
    Face(&'static str),
    /// A quarter of the lamp's distance across.
    Ball,
    /// All around the lamp.
    Bulb,
}

/// A picture of the middle of a ground, the plane z = 0 of the case's own axes, with a lamp above it and a wall just below
/// the lamp or, where `before` is negative, just above.
#[derive(Clone, Copy, Debug)]
struct Lamp {
    wall: Wall,
    place: Place,
    distance: f32,
    /// From the ground's normal.
    degrees: f32,
    before: f32,
}

impl Lamp {
    fn is_lit_everywhere_or_nowhere(self, is_lit: bool) {
        let Self { place, distance, before, .. } = self;
        let (sin, cos) = self.degrees.to_radians().sin_cos();
        let lamp = distance * Vec3::new(0.6 * sin, 0.8 * sin, cos);
        let corners = |size: f32, center: Vec3| {
            [[-1.3, -0.9], [1.1, -1.0], [-0.2, 1.2]].map(|[x, y]| center + size * Vec3::new(x, y, 0.0))
        };
        let ball = |center: Vec3, radius: f32| {
            format!("[[sphere]]\ncenter = {}\nradius = {radius:e}\nmaterial = \"m\"\n", place.text(center))
        };
        let wall = match self.wall {
            Wall::Face(kind) => place.face(kind, &corners(distance / 4.0, lamp - before * Vec3::Z), "m"),
            Wall::Ball => {
                let radius = distance / 8.0;
                ball(lamp - (before + radius.copysign(before)) * lamp.normalize(), radius)
            }
            Wall::Bulb => ball(lamp, before),
        };
        let scene = scene(&format!(
            "[image]\nsize = [12, 12]\n[camera]\nkind = \"orthographic\"\neye = {}\ntarget = {}\nup = {:?}\nheight = {}\n\
             [[light]]\nposition = {}\n[material.m]\ndiffuse = 1\n{}{wall}",
            place.text(Vec3::Z * distance / 64.0),
            place.text(Vec3::ZERO),
            place.direction(Vec3::Y).to_array(),
            distance / 16.0,
            place.text(lamp),
            place.face("polygon", &corners(distance, Vec3::ZERO), "m"),
        ));
        for engine in engines() {
            let image = render_with(&scene, engine).image;
            let lit = image.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
            assert_eq!(lit, if is_lit { image.pixels.len() } else { 0 }, "lit of {self:?}, {engine:?}");
        }
    }
}

/// Case 53: Wall just before the lamp: it blocks down to 16u of the distance, and just behind the lamp it does not.
#[test]
fn case_53_wall_just_before_the_lamp() {
    for wall in [Wall::Face("polygon"), Wall::Face("triangle"), Wall::Ball, Wall::Bulb] {
        for (turned, offset) in [(false, 0.0), (true, 0.0), (true, 0.5)] {
            for distance in [1.0, 100.0, 1e4] {
                for roundings in [16.0, 100.0, 10_000.0] {
                    let before = roundings * U as f32 * distance;
                    let place = Place { turned, offset: offset * distance };
                    // A ball is met head-on.
                    let angles =
                        if matches!(wall, Wall::Face(_)) { &[0.0, 45.0, 75.0][..] } else { &[0.0, 45.0] };
                    for &degrees in angles {
                        let lamp = Lamp { wall, place, distance, degrees, before };
                        lamp.is_lit_everywhere_or_nowhere(false);
                        if !matches!(wall, Wall::Bulb) {
                            Lamp { before: -before, ..lamp }.is_lit_everywhere_or_nowhere(true);
                        }
                    }
                }
            }
        }
    }
}
