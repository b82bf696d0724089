//! Shapes that several cases share, and rays that are aimed at their edges and corners.

use super::case::{Aimed, Shape, ray};
use glam::{DQuat, DVec3, EulerRot};
use std::collections::BTreeMap;

/// Rounds a point once.
pub(super) fn rounded(point: DVec3) -> [f32; 3] {
    point.as_vec3().to_array()
}

/// Some rotation that leaves no axis, diagonal or plane of symmetry where it was.
pub(super) fn turned(point: DVec3) -> DVec3 {
    DQuat::from_euler(EulerRot::XYZ, 0.37, 1.13, -0.71) * point
}

/// A ray from an origin to a point, as exactly as f32 can.
pub(super) fn aimed_at(origin: [f32; 3], target: DVec3) -> Aimed {
    ray(origin, rounded(target - DVec3::from(origin.map(f64::from))))
}

/// Faces of more than three corners as they are, or as fans of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Made {
    Polygons,
    Triangles,
    /// Every other face.
    Both,
}

impl Made {
    pub(super) fn shapes(self, faces: &[Vec<[f32; 3]>]) -> Vec<Shape> {
        let face = |(index, corners): (usize, &Vec<[f32; 3]>)| {
            let whole = self == Self::Polygons || (self == Self::Both && index % 2 == 0);
            if whole {
                return vec![Shape::Polygon(corners.clone())];
            }
            let fan = corners[1..].windows(2);
            fan.map(|edge| Shape::Triangle([corners[0], edge[0], edge[1]])).collect()
        };
        faces.iter().enumerate().flat_map(face).collect()
    }
}

/// A point of the world for a point of the solid.
pub(super) type Placing = fn(DVec3) -> DVec3;

/// The faces of the cube from −1 to 1, each cut into n × n squares, corners counter-clockwise as seen from outside.
pub(super) fn cube_faces(n: u8, place: Placing) -> Vec<Vec<[f32; 3]>> {
    let mut faces = Vec::new();
    for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let corner = |i: u8, j: u8| {
                let along = |step: u8| 2.0 * f64::from(step) / f64::from(n) - 1.0;
                let mut point = DVec3::splat(side);
                (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (along(i), along(j) * side);
                rounded(place(point))
            };
            faces.push(vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
        }
    }
    faces
}

/// All corners of faces, and points in quarters along all of their edges, each edge once.
pub(super) fn seams(faces: &[Vec<[f32; 3]>]) -> Vec<DVec3> {
    let bits = |corner: [f32; 3]| corner.map(f32::to_bits);
    let edges = faces.iter().flat_map(|face| {
        let next = face.iter().cycle().skip(1);
        face.iter().zip(next)
    });
    let once: BTreeMap<_, _> = edges
        .flat_map(|(&from, &to)| {
            let [low, high] = if bits(from) < bits(to) { [from, to] } else { [to, from] };
            (0..=4_u8).map(move |quarter| {
                let [from, to] = [low, high].map(|corner| DVec3::from(corner.map(f64::from)));
                let point = from.lerp(to, f64::from(quarter) / 4.0);
                (point.to_array().map(f64::to_bits), point)
            })
        })
        .collect();
    once.into_values().collect()
}

/// The faces of a globe: triangles at both poles and two between any two meridians and parallels. `radius` is asked for each
/// vertex by its number.
pub(super) fn globe_faces(
    rings: u32,
    sectors: u32,
    center: DVec3,
    radius: impl Fn(u32) -> f64,
) -> Vec<Vec<[f32; 3]>> {
    use std::f64::consts::{PI, TAU};
    let point = |ring: u32, sector: u32| {
        let number = match ring {
            0 => 0,
            ring if ring == rings => 1,
            ring => 2 + (ring - 1) * sectors + sector % sectors,
        };
        let polar = PI * f64::from(ring) / f64::from(rings);
        let azimuth = TAU * f64::from(sector % sectors) / f64::from(sectors);
        let (sine, cosine) = if number < 2 { (0.0, polar.cos().round()) } else { polar.sin_cos() };
        let way = DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine);
        rounded(center + radius(number) * way)
    };
    let mut faces = Vec::new();
    for (ring, sector) in (0..rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector))) {
        let [a, b] = [point(ring, sector), point(ring + 1, sector)];
        let [c, d] = [point(ring + 1, sector + 1), point(ring, sector + 1)];
        if ring + 1 < rings {
            faces.push(vec![a, b, c]);
        }
        if ring > 0 {
            faces.push(vec![a, c, d]);
        }
    }
    faces
}

/// A number from 0 to 1 for each index, the same on every machine: the fractional part of a multiple of the golden ratio.
pub(super) fn spread(index: u32) -> f64 {
    f64::from(index.wrapping_mul(2_654_435_769)) / 2.0_f64.powi(32)
}
