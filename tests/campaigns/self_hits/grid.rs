//! Shapes with corners on an integer grid, mapped by a power of two: so faces are plane and solids convex without rounding,
//! however they are turned and wherever they stand.

use super::bodies::{Body, Face};
use crate::random::Random;
use glam::{DQuat, DVec3, I64Vec3, Vec3};
use wavelane::scene::{Geometry, MaterialId};

/// Corners of faces, each seen counter-clockwise from outside.
pub(super) type Loops = Vec<Vec<I64Vec3>>;

/// Where the grid is in the world.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    /// World length of a step, a power of two.
    step: f64,
    offset: I64Vec3,
    /// Steps across what is to stand here.
    pub(super) size: i64,
}

/// What faces are made of.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Style {
    Triangles,
    Polygons,
    Both,
}

impl Grid {
    /// Sizes of 2⁻²⁰ to 2²⁰, 0 to 2¹⁶ of them away from the origin. `most` is the largest coordinate of what is to stand
    /// there, in sizes.
    pub(super) fn random(most: i64, random: &mut Random) -> Self {
        // What f32 has room for: 24 bits.
        let room = 23 - (most as f64).log2().ceil() as i64;
        let away = if random.one_in(4) { None } else { Some(random.whole(0, 16)) };
        let bits = random.whole(6, away.map_or(room, |away| (22 - away).min(room)).clamp(6, 19));
        let direction = random.direction();
        let offset = away.map_or(DVec3::ZERO, |away| {
            direction / direction.abs().max_element() * ((1_i64 << (bits + away)) as f64)
        });
        Self {
            step: 2.0_f64.powi((random.whole(-20, 20) - bits) as i32),
            offset: offset.round().as_i64vec3(),
            size: 1 << bits,
        }
    }

    pub(super) fn world_size(&self) -> f64 {
        self.size as f64 * self.step
    }

    pub(super) fn world(&self, point: I64Vec3) -> DVec3 {
        (point + self.offset).as_dvec3() * self.step
    }

    /// The same, without rounding.
    pub(super) fn vertex(&self, point: I64Vec3) -> Vec3 {
        let world = self.world(point);
        assert_eq!(world.as_vec3().as_dvec3(), world, "f32 has room for the grid");
        world.as_vec3()
    }

    /// Adds faces, and returns them as they are in the scene.
    pub(super) fn add(
        &self,
        loops: &[Vec<I64Vec3>],
        style: Style,
        geometry: &mut Geometry,
        random: &mut Random,
    ) -> Vec<Face> {
        let glass = MaterialId(0);
        let first = geometry.numbered_count();
        for corners in loops {
            let corners: Vec<Vec3> = corners.iter().map(|&corner| self.vertex(corner)).collect();
            let is_split = match style {
                Style::Triangles => true,
                Style::Polygons => false,
                Style::Both => random.one_in(2),
            };
            if !is_split {
                geometry.add_polygon(&corners, None, glass).unwrap();
                continue;
            }
            let first = geometry.add_vertices(corners.iter().copied()).unwrap();
            for k in 1..corners.len() as u32 - 1 {
                geometry.add_triangle([first, first + k, first + k + 1], None, glass).unwrap();
            }
        }
        Face::all(geometry, first..geometry.numbered_count())
    }

    /// The same of a closed solid; none if its faces are not convex after all.
    pub(super) fn add_solid(
        &self,
        loops: &Loops,
        style: Style,
        geometry: &mut Geometry,
        random: &mut Random,
    ) -> Option<Body> {
        let faces = self.add(loops, style, geometry, random);
        Body::is_convex(&faces).then_some(Body::Solid(faces))
    }
}

/// Three vectors of the grid, at right angles but for the rounding, turned at random.
pub(super) fn frame(lengths: [f64; 3], random: &mut Random) -> [I64Vec3; 3] {
    loop {
        let turn = random.turn();
        let turn = if random.one_in(8) { DQuat::IDENTITY } else { turn };
        let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::Z];
        let [a, b, c] =
            [(a, 0), (b, 1), (c, 2)].map(|(axis, place)| (turn * axis * lengths[place]).round().as_i64vec3());
        if a.cross(b).dot(c) > 0 {
            return [a, b, c];
        }
    }
}

/// A convex outline (i, j), counter-clockwise, in the plane of a and b, drawn out along c.
pub(super) fn prism(outline: &[[i64; 2]], from: I64Vec3, [a, b, c]: [I64Vec3; 3]) -> Loops {
    let point = |[i, j]: [i64; 2]| from + a * i + b * j;
    let bottom = outline.iter().rev().map(|&place| point(place)).collect();
    let top = outline.iter().map(|&place| point(place) + c).collect();
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next).map(|(&one, &other)| {
        let (one, other) = (point(one), point(other));
        vec![one, other, other + c, one + c]
    });
    [bottom, top].into_iter().chain(sides).collect()
}

pub(super) const SQUARE: [[i64; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];
pub(super) const OCTAGON: [[i64; 2]; 8] = [[1, 0], [2, 0], [3, 1], [3, 2], [2, 3], [1, 3], [0, 2], [0, 1]];
/// Three that are not convex.
pub(super) const ANGLE: [[i64; 2]; 6] = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]];
pub(super) const STAR: [[i64; 2]; 8] = [[0, 3], [2, 2], [3, 0], [4, 2], [6, 3], [4, 4], [3, 6], [2, 4]];
pub(super) const COMB: [[i64; 2]; 8] = [[0, 0], [5, 0], [5, 4], [4, 4], [4, 1], [1, 1], [1, 4], [0, 4]];

/// An icosahedron whose faces are cut in four some times, its corners put on the grid.
pub(super) fn icosphere(diameter: f64, times: u32, random: &mut Random) -> Loops {
    let turn = random.turn();
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    // Neighbours of the twelve corners are 2 apart.
    let mut corners = Vec::new();
    for (one, other) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        corners.extend([
            DVec3::new(0.0, one, other),
            DVec3::new(one, other, 0.0),
            DVec3::new(other, 0.0, one),
        ]);
    }
    let mut triangles = Vec::new();
    for (i, j, k) in (0..12).flat_map(|i| (i + 1..12).flat_map(move |j| (j + 1..12).map(move |k| (i, j, k))))
    {
        let [a, b, c] = [corners[i], corners[j], corners[k]];
        if [(a, b), (b, c), (c, a)].iter().all(|(one, other)| (one.distance(*other) - 2.0).abs() < 1e-6) {
            let outward = (b - a).cross(c - a).dot(a) > 0.0;
            triangles.push(if outward { [a, b, c] } else { [a, c, b] }.map(DVec3::normalize));
        }
    }
    for _ in 0..times {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let on_grid = |corner: DVec3| (turn * corner * (diameter / 2.0)).round().as_i64vec3();
    triangles.into_iter().map(|triangle| triangle.map(on_grid).to_vec()).collect()
}
