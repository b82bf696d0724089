//! Closed surfaces that are round, or were: globes, a ring, needles.

use super::solid::{Made, Solid};
use crate::random::Random;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

fn on_sphere(polar: f64, around: f64) -> DVec3 {
    (polar.sin() * DVec2::from_angle(around)).extend(polar.cos())
}

/// Rings of corners between two poles, which are corners 0 and 1.
struct Rings {
    rings: usize,
    round: usize,
}

impl Rings {
    fn at(&self, ring: usize, step: usize) -> usize {
        match ring {
            0 => 0,
            ring if ring == self.rings => 1,
            _ => 2 + (ring - 1) * self.round + step % self.round,
        }
    }

    /// Corners, each at the given distance from the middle.
    fn corners(&self, mut radius: impl FnMut() -> f64) -> Vec<DVec3> {
        let mut corners = vec![radius() * DVec3::Z, radius() * DVec3::NEG_Z];
        for ring in 1..self.rings {
            for step in 0..self.round {
                let polar = PI * ring as f64 / self.rings as f64;
                corners.push(radius() * on_sphere(polar, TAU * step as f64 / self.round as f64));
            }
        }
        corners
    }
}

/// Corners at random distances from the middle, of which the whole surface can be seen: pbrt's watertight test is of such a
/// one, 16 × 16 at distances from 1 to 6.
pub(super) fn bumpy_globe(random: &mut Random) -> Solid {
    let rings = Rings { rings: 16, round: 16 };
    let mut solid = Solid::new(rings.corners(|| random.between(1.0, 6.0)), vec![DVec3::ZERO]);
    for ring in 0..rings.rings {
        for step in 0..rings.round {
            let [a, b] = [rings.at(ring, step), rings.at(ring, step + 1)];
            let [c, d] = [rings.at(ring + 1, step), rings.at(ring + 1, step + 1)];
            if ring > 0 {
                solid.add(ring, &[a, d, b]);
            }
            if ring + 1 < rings.rings {
                solid.add(ring, &[a, c, d]);
            }
        }
    }
    solid
}

/// A globe of quads, with a cap of triangles at one pole and one polygon in the place of the other.
pub(super) fn globe_of_both() -> Solid {
    let rings = Rings { rings: 12, round: 20 };
    let mut solid = Solid::new(rings.corners(|| 1.0), vec![DVec3::ZERO]);
    let last = rings.rings - 1;
    for step in 0..rings.round {
        solid.add(0, &[0, rings.at(1, step), rings.at(1, step + 1)]);
        for ring in 1..last {
            let [a, b] = [rings.at(ring, step), rings.at(ring, step + 1)];
            let [c, d] = [rings.at(ring + 1, step), rings.at(ring + 1, step + 1)];
            solid.add_quad(ring, [a, c, d, b], Made::Polygons);
        }
    }
    solid.add(last, &(0..rings.round).rev().map(|step| rings.at(last, step)).collect::<Vec<_>>());
    // The pole that nothing uses: the last corner takes its place.
    let moved = solid.corners.len() - 1;
    solid.corners.swap_remove(1);
    for corner in solid.faces.iter_mut().flat_map(|face| &mut face.corners) {
        *corner = if *corner == moved { 1 } else { *corner };
    }
    solid
}

/// An icosahedron, each face split in 64. What was one face is a strip.
pub(super) fn icosphere() -> Solid {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (one, other) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([
            DVec3::new(0.0, one, other),
            DVec3::new(one, other, 0.0),
            DVec3::new(other, 0.0, one),
        ]);
    }
    let mut solid = Solid::new(corners.into_iter().map(DVec3::normalize).collect(), vec![DVec3::ZERO]);
    let mut faces: Vec<(usize, [usize; 3])> = Vec::new();
    let are_near = |a: usize, b: usize| solid.corners[a].dot(solid.corners[b]) > 0.4;
    for a in 0..12 {
        for (b, c) in (a + 1..12).flat_map(|b| (b + 1..12).map(move |c| (b, c))) {
            if are_near(a, b) && are_near(b, c) && are_near(c, a) {
                let [p, q, r] = [a, b, c].map(|corner| solid.corners[corner]);
                let is_outward = (q - p).cross(r - p).dot(p) > 0.0;
                faces.push((faces.len(), if is_outward { [a, b, c] } else { [a, c, b] }));
            }
        }
    }
    for _ in 0..3 {
        let mut middles = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                solid.corners.push((solid.corners[a] + solid.corners[b]).normalize());
                solid.corners.len() - 1
            })
        };
        let split = faces.iter().flat_map(|&(strip, [a, b, c])| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|face| (strip, face))
        });
        faces = split.collect();
    }
    for (strip, face) in faces {
        solid.add(strip, &face);
    }
    solid
}

/// A torus: no point sees all of it.
pub(super) fn torus() -> Solid {
    const RINGS: usize = 24;
    const ROUND: usize = 14;
    let middle = |ring: usize| DVec2::from_angle(TAU * ring as f64 / RINGS as f64);
    let mut corners = Vec::new();
    for (ring, step) in (0..RINGS).flat_map(|ring| (0..ROUND).map(move |step| (ring, step))) {
        let (sin, cos) = (TAU * step as f64 / ROUND as f64).sin_cos();
        corners.push(((1.0 + 0.4 * cos) * middle(ring)).extend(0.4 * sin));
    }
    let inside = (0..RINGS).map(|ring| (0.98 * middle(ring)).extend(0.0)).collect();
    let mut solid = Solid::new(corners, inside);
    let at = |ring: usize, step: usize| ring % RINGS * ROUND + step % ROUND;
    for (ring, step) in (0..RINGS).flat_map(|ring| (0..ROUND).map(move |step| (ring, step))) {
        let quad = [at(ring, step), at(ring + 1, step), at(ring + 1, step + 1), at(ring, step + 1)];
        solid.add_quad(ring, quad, Made::Triangles);
    }
    solid
}

/// Two thin spikes on a common base: up to 512 times as long as thick.
pub(super) fn needle(random: &mut Random) -> Solid {
    let sides = 3 + random.below(5);
    let thickness = random.between(-9.0, -3.0).exp2();
    let mut corners = vec![DVec3::Z, DVec3::NEG_Z];
    corners.extend((0..sides).map(|side| {
        let around = DVec2::from_angle(TAU * (side as f64 + random.between(0.0, 0.3)) / sides as f64);
        (thickness * around).extend(0.0)
    }));
    let mut solid = Solid::new(corners, vec![DVec3::ZERO]);
    for side in 0..sides {
        let [a, b] = [2 + side, 2 + (side + 1) % sides];
        solid.add(0, &[0, a, b]);
        solid.add(1, &[1, b, a]);
    }
    solid
}
