//! From inside a closed surface every ray hits it: also one aimed at a corner or at an edge, where two faces have to agree.
//!
//! Random rays do not find cracks; aimed ones find them at once (Schirra, "How Reliable Are Practical Point-in-Polygon
//! Strategies?", 2008).

use super::Random;
use super::brute_force::Query;
use super::rays::{By, Walk, assert_same_as_all};
use super::scenes::scene_of;
use crate::kernel::tests::sight::Sight;
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::scene::{Geometry, MaterialId, Scene};
use crate::traverse::NOTHING;
use glam::{DMat3, DQuat, DVec3, Vec3};

/// A closed surface around a point that sees all of it.
struct Closed {
    scene: Scene,
    middle: DVec3,
    corners: Vec<DVec3>,
    edges: Vec<[DVec3; 2]>,
}

/// Where a surface is and how large.
#[derive(Clone, Copy, Debug)]
struct Pose {
    size: f64,
    middle: DVec3,
}

const POSES: [Pose; 4] = [
    Pose { size: 1.0, middle: DVec3::ZERO },
    Pose { size: 1e-3, middle: DVec3::ONE },
    Pose { size: 2e4, middle: DVec3::new(-17.0, 3.0, 8.0) },
    Pose { size: 2.0, middle: DVec3::new(1483.76, 12.34, -2234.23) },
];

fn turn(random: &mut Random) -> DMat3 {
    DMat3::from_quat(DQuat::from_axis_angle(random.vector().normalize(), random.between(0.0, 6.0)))
}

/// Faces by the numbers of their corners.
fn closed(pose: Pose, corners: &[DVec3], faces: &[Vec<usize>]) -> Closed {
    let corners: Vec<Vec3> =
        corners.iter().map(|&corner| (pose.middle + pose.size * corner).as_vec3()).collect();
    let mut geometry = Geometry::default();
    let material = MaterialId(0);
    let first = geometry.add_vertices(corners.iter().copied()).unwrap();
    for face in faces {
        if let [a, b, c] = face[..] {
            let corners = [a, b, c].map(|corner| first + u32::try_from(corner).unwrap());
            geometry.add_triangle(corners, None, material).unwrap();
        } else {
            let corners: Vec<Vec3> = face.iter().map(|&corner| corners[corner]).collect();
            geometry.add_polygon(&corners, None, material).unwrap();
        }
    }
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let edges = faces
        .iter()
        .flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)))
        .map(|(&from, &to)| [corners[from], corners[to]])
        .collect();
    Closed { scene: scene_of(geometry), middle: pose.middle, corners, edges }
}

/// A globe of rings of triangles whose corners are at distances between 1 and 3: pbrt's watertight test has such a one.
fn star(random: &mut Random, pose: Pose) -> Closed {
    const RINGS: usize = 8;
    const ROUND: usize = 12;
    let turn = turn(random);
    let mut corners = vec![turn * DVec3::Z, turn * DVec3::NEG_Z];
    for ring in 1..RINGS {
        for step in 0..ROUND {
            let (polar, around) = (180.0 / RINGS as f64 * ring as f64, 360.0 / ROUND as f64 * step as f64);
            let ((s, z), (y, x)) = (polar.to_radians().sin_cos(), around.to_radians().sin_cos());
            corners.push(turn * (DVec3::new(s * x, s * y, z) * random.between(1.0, 3.0)));
        }
    }
    let at = |ring: usize, step: usize| match ring {
        0 => 0,
        RINGS => 1,
        _ => 2 + (ring - 1) * ROUND + step % ROUND,
    };
    let faces: Vec<Vec<usize>> = (0..RINGS)
        .flat_map(|ring| (0..ROUND).map(move |step| (ring, step)))
        .flat_map(|(ring, step)| {
            let (above, below) =
                ([at(ring, step), at(ring, step + 1)], [at(ring + 1, step), at(ring + 1, step + 1)]);
            let upper = (ring > 0).then(|| vec![above[0], below[1], above[1]]);
            let lower = (ring + 1 < RINGS).then(|| vec![above[0], below[0], below[1]]);
            upper.into_iter().chain(lower)
        })
        .collect();
    closed(pose, &corners, &faces)
}

/// A brick of six squares, turned.
fn brick(random: &mut Random, pose: Pose) -> Closed {
    let turn = turn(random);
    let sides = DVec3::new(1.0, random.between(0.1, 1.0), random.between(0.1, 1.0));
    let corners: Vec<DVec3> = (0..8)
        .map(|at: u32| {
            let sign = |axis: u32| if at >> axis & 1 == 1 { 1.0 } else { -1.0 };
            turn * (sides * DVec3::new(sign(0), sign(1), sign(2)))
        })
        .collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .map(|face| face.to_vec());
    closed(pose, &corners, &faces)
}

impl Closed {
    /// From near the middle, or from where much of the surface is seen nearly edge-on, at a corner, at an edge or anywhere.
    fn rays(&self, random: &mut Random, prepared: &Prepared<'_>, count: usize) -> Vec<Query> {
        let factor = f64::from(prepared.scale.factor());
        let rays = (0..count).map(|at| {
            let corner = self.corners[random.below(self.corners.len())];
            let start = self.middle + random.between(0.0, 0.3) * (corner - self.middle);
            let target = match at % 3 {
                0 => self.corners[random.below(self.corners.len())],
                1 => {
                    let [from, to] = self.edges[random.below(self.edges.len())];
                    from.lerp(to, if random.chance(0.3) { 0.5 } else { random.unit() })
                }
                _ => start + random.vector(),
            };
            // As a ray would have them: rounded to f32 in the engine's scale, the direction of any length.
            let origin = (start * factor).as_vec3().as_dvec3();
            Query::new(Sight::new(origin, target * factor - origin))
        });
        rays.collect()
    }
}

/// Rays of a walk that find no way out of a closed surface have leaked. Sorted so that some walk in packets.
fn assert_closed(closed: &Closed, random: &mut Random, count: usize, width: Width, pose: Pose) -> u64 {
    let prepared = Prepared::new(&closed.scene).unwrap();
    let mut rays = closed.rays(random, &prepared, count);
    let order = |ray: &Query| {
        let d = ray.sight.direction.map(f32::is_sign_negative);
        let steps = (ray.sight.d() / ray.sight.d().abs().max_element() * 4.0).round();
        (ray.sight.third(), d, steps.to_array().map(f64::to_bits))
    };
    rays.sort_by_key(order);
    let found = width.run(Walk {
        hierarchy: &prepared.hierarchy,
        rays: &rays,
        departing: false,
        any: false,
        by: By::Rows,
    });
    let leaks: Vec<&Query> =
        rays.iter().zip(&found.id).filter(|(_, id)| **id == NOTHING).map(|(ray, _)| ray).collect();
    assert!(leaks.is_empty(), "{} of {count} rays leak at {pose:?}, one of them {:?}", leaks.len(), leaks[0]);
    found.counts.in_packets
}

#[test]
fn no_ray_leaks_out_of_a_closed_mesh() {
    let mut in_packets = 0;
    for (seed, pose) in (0..).zip(POSES) {
        for round in 0..4 {
            let random = &mut Random::new(10 * seed + round);
            let star = star(random, pose);
            in_packets += assert_closed(&star, random, 50_000, Width::BEST, pose);
        }
    }
    assert!(in_packets > 10_000, "{in_packets} rays in packets");
}

#[test]
fn no_ray_leaks_out_of_a_brick_of_polygons() {
    let mut in_packets = 0;
    for (seed, pose) in (0..).zip(POSES) {
        for round in 0..10 {
            let random = &mut Random::new(1000 + 10 * seed + round);
            let brick = brick(random, pose);
            in_packets += assert_closed(&brick, random, 20_000, Width::BEST, pose);
        }
    }
    assert!(in_packets > 10_000, "{in_packets} rays in packets");
}

#[test]
fn rays_aimed_at_corners_and_edges_find_what_a_loop_over_all_faces_finds() {
    for (seed, pose) in (0..).zip(POSES) {
        let random = &mut Random::new(2000 + seed);
        for closed in [star(random, pose), brick(random, pose)] {
            let prepared = Prepared::new(&closed.scene).unwrap();
            let rays = closed.rays(random, &prepared, 2000);
            assert_same_as_all(&prepared, &rays, false);
        }
    }
}
