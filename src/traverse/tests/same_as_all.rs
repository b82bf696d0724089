//! Both queries, at every width, in packets and alone, against the loop over all primitives.

use super::Random;
use super::brute_force::Query;
use super::rays::{assert_same_as_all, begin, coherent, end, shuffled};
use super::scenes::mixed;
use crate::kernel::tests::sight::Sight;
use crate::prepare::{Hierarchy, Prepared};
use crate::scene::{Geometry, MaterialId, Scene};
use crate::traverse::{NOTHING, NOWHERE};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

fn ray_count() -> impl Strategy<Value = usize> {
    prop_oneof![3 => 1..=130_usize, 1 => Just(64), 1 => Just(128)]
}

/// A point of a primitive, as a ray's start would be rounded to f32, and its outward normal.
fn start_on(hierarchy: &Hierarchy, id: u32, random: &mut Random) -> Option<(DVec3, DVec3)> {
    for block in &hierarchy.spheres {
        if let Some(lane) = block.ids.iter().position(|&other| other == id) {
            let center = Vec3::from(block.centers.map(|column| column[lane])).as_dvec3();
            let normal = random.vector().normalize_or(DVec3::X);
            return Some((center + f64::from(block.radii[lane]) * normal, normal));
        }
    }
    for block in &hierarchy.triangles {
        if let Some(lane) = block.ids.iter().position(|&other| other == id) {
            let [a, b, c] =
                block.vertices.map(|corner| Vec3::from(corner.map(|column| column[lane])).as_dvec3());
            // Corners and edges are where others touch it.
            let (v, w) = if random.chance(0.3) { (0.0, 0.5) } else { (random.unit(), random.unit()) };
            let point = a + v * (b - a) + (1.0 - v) * w * (c - a);
            return Some((point, (b - a).cross(c - a).normalize()));
        }
    }
    let face = hierarchy.polygons.iter().find(|face| face.id == id)?;
    let corner = |at: usize| {
        let index = face.first_corner as usize + at;
        Vec3::from([0, 1, 2].map(|axis| hierarchy.corners[axis][index])).as_dvec3()
    };
    Some((corner(0).lerp(corner(1), random.unit()), Vec3::from(face.normal).as_dvec3()))
}

/// Lets rays start on primitives, going in or out, or merely says so: then they go out, since a way through the inside is
/// only known from a start on the surface.
fn depart(random: &mut Random, scene: &Scene, hierarchy: &Hierarchy, rays: &mut [Query], move_there: bool) {
    for ray in rays {
        let id = u32::try_from(random.below(scene.geometry.primitive_count() + 1)).unwrap();
        let inward = u32::from(move_there && random.chance(0.5));
        let Some((point, normal)) = start_on(hierarchy, id, random) else { continue };
        ray.departure = 2 * id + inward;
        if move_there {
            let sign = if inward == 1 { -1.0 } else { 1.0 };
            let mut direction = ray.sight.d();
            if direction.dot(normal) * sign < 0.0 {
                direction = -direction;
            }
            ray.sight = Sight::new(point, direction);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn rays_find_what_a_loop_over_all_primitives_finds(
        seed in any::<u64>(),
        size in prop_oneof![3 => 1..60_usize, 1 => 60..400_usize],
        count in ray_count(),
        begins in any::<bool>(),
        ends in any::<bool>(),
        departs in any::<bool>(),
        shadowless in prop_oneof![Just(0.0), Just(0.5), Just(1.0)],
    ) {
        let random = &mut Random::new(seed);
        let scene = mixed(random, size, shadowless);
        let prepared = Prepared::new(&scene).unwrap();
        for mut rays in [coherent(random, count), shuffled(random, count)] {
            if ends {
                end(random, &mut rays);
            }
            if departs {
                let move_there = random.chance(0.7);
                depart(random, &scene, &prepared.hierarchy, &mut rays, move_there);
            } else if begins {
                begin(random, &mut rays);
            }
            assert_same_as_all(&prepared, &rays, departs);
        }
    }
}

/// Straight through a row of faces: the first one beyond `t_min` is seen, of a sphere its far side where need be.
#[test]
fn hits_up_to_t_min_do_not_count() {
    let mut geometry = Geometry::default();
    let material = MaterialId(0);
    for z in [0.0, -1.0, -2.0] {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, z));
        geometry.add_polygon(&corners, None, material).unwrap();
    }
    let first =
        geometry.add_vertices([[-4.0, -4.0], [4.0, -4.0], [0.0, 4.0]].map(|[x, y]| Vec3::new(x, y, -3.0)));
    let first = first.unwrap();
    geometry.add_triangle([first, first + 1, first + 2], None, material).unwrap();
    geometry.add_sphere(Vec3::new(0.25, 0.25, -6.0), 1.0, material).unwrap();
    let scene = Scene { geometry, ..mixed(&mut Random::new(1), 1, 0.0) };
    let prepared = Prepared::new(&scene).unwrap();
    let sight = Sight::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let cases = [
        (0.0, 1.0, 0),
        (0.5, 1.0, 0),
        (1.0, 2.0, 1),
        (1.5, 2.0, 1),
        (2.0, 3.0, 2),
        (3.0, 4.0, 3),
        (4.0, 6.0, 4),
        (6.0, 8.0, 4),
        (8.0, f32::INFINITY, NOTHING),
    ];
    for (t_min, t, id) in cases {
        let ray = Query { t_min, ..Query::new(sight) };
        let scale = prepared.scale.factor();
        let scaled =
            Query { t_min: t_min * scale, sight: Sight::new(sight.o() * f64::from(scale), sight.d()), ..ray };
        let found = scaled.closest::<false>(&prepared.hierarchy);
        assert_eq!((found.0 / scale, found.1), (t, id), "beyond {t_min}");
        assert_same_as_all(&prepared, &[scaled; 70], false);
    }
}

/// The property above would hold for walks that never make up a packet, or never hit.
#[test]
fn coherent_rays_walk_in_packets_and_shuffled_ones_in_streams() {
    let (mut packets, mut coherent_hits, mut shuffled_hits) = (0, 0, 0);
    for seed in 0..40 {
        let random = &mut Random::new(seed);
        let scene = mixed(random, 60, 0.3);
        let prepared = Prepared::new(&scene).unwrap();
        let (in_packets, hits) = assert_same_as_all(&prepared, &coherent(random, 128), false);
        // The second packet of a width is not tried where the first was dear.
        packets += u64::from(in_packets >= 4 * 64);
        coherent_hits += hits;
        let (in_packets, hits) = assert_same_as_all(&prepared, &shuffled(random, 128), false);
        assert_eq!(in_packets, 0);
        shuffled_hits += hits;
    }
    assert!(packets >= 30, "{packets} of 40 runs of coherent rays in packets");
    assert!(coherent_hits > 1000 && shuffled_hits > 1000, "{coherent_hits} and {shuffled_hits} hits");
}

/// Tails of every length.
#[test]
fn any_number_of_rays_can_be_traced() {
    let random = &mut Random::new(7);
    let scene = mixed(random, 40, 0.2);
    let prepared = Prepared::new(&scene).unwrap();
    let (coherent, shuffled) = (coherent(random, 130), shuffled(random, 130));
    for count in 1..=130 {
        for rays in [&coherent, &shuffled] {
            assert_same_as_all(&prepared, &rays[..count], false);
        }
    }
}

/// A run of each in one call: what a packet leaves behind does not reach the rays after it.
#[test]
fn runs_of_different_kinds_follow_each_other() {
    for seed in 100..120 {
        let random = &mut Random::new(seed);
        let scene = mixed(random, 80, 0.3);
        let prepared = Prepared::new(&scene).unwrap();
        let mut rays = Vec::new();
        for _ in 0..3 {
            rays.extend(coherent(random, 64));
            rays.extend(shuffled(random, 64));
        }
        end(random, &mut rays);
        assert_same_as_all(&prepared, &rays, false);
        depart(random, &scene, &prepared.hierarchy, &mut rays, false);
        assert_same_as_all(&prepared, &rays, true);
    }
}

/// Of two spheres in one place the first is seen, from the eye as well after rays that started on it: for these one of its roots
/// is no hit.
#[test]
fn rays_from_the_eye_forget_where_those_before_them_started() {
    let mut geometry = Geometry::default();
    for _ in 0..2 {
        geometry.add_sphere(Vec3::new(0.0, 0.0, -3.0), 1.0, MaterialId(0)).unwrap();
    }
    let scene = Scene { geometry, ..mixed(&mut Random::new(1), 1, 0.0) };
    let prepared = Prepared::new(&scene).unwrap();
    let toward =
        |row: u32| DVec3::new(f64::from(row % 8) / 40.0 + 0.01, f64::from(row / 8) / 40.0 + 0.01, -1.0);
    let mut rays: Vec<Query> = (0..64).map(|row| Query::new(Sight::new(DVec3::ZERO, toward(row)))).collect();
    for departs in [true, false] {
        for ray in &mut rays {
            ray.departure = if departs { 0 } else { NOWHERE };
        }
        let (in_packets, hits) = assert_same_as_all(&prepared, &rays, departs);
        assert!(in_packets > 0 && hits > 0, "{in_packets} in packets, {hits} hits");
    }
}

/// The loop goes over what the hierarchy holds, which has to be the scene.
#[test]
fn the_hierarchy_holds_every_primitive_once() {
    for (seed, size) in (0..20).zip((1..).step_by(20)) {
        let scene = mixed(&mut Random::new(seed), size, 0.0);
        let prepared = Prepared::new(&scene).unwrap();
        let hierarchy = &prepared.hierarchy;
        let (geometry, scale) = (&scene.geometry, prepared.scale);
        let bits = |point: Vec3| point.to_array().map(f32::to_bits);

        let mut found: Vec<(u32, Vec<[u32; 3]>)> = Vec::new();
        for block in &hierarchy.triangles {
            for (lane, &id) in block.ids.iter().enumerate().filter(|(_, id)| **id != NOTHING) {
                found.push((
                    id,
                    block.vertices.map(|corner| corner.map(|axis| axis[lane].to_bits())).to_vec(),
                ));
            }
        }
        for block in &hierarchy.spheres {
            for (lane, &id) in block.ids.iter().enumerate().filter(|(_, id)| **id != NOTHING) {
                let radius = [block.radii[lane].to_bits(); 3];
                found.push((id, vec![block.centers.map(|axis| axis[lane].to_bits()), radius]));
            }
        }
        for face in &hierarchy.polygons {
            let run = face.first_corner as usize..(face.first_corner + face.edges) as usize;
            let corners = run.map(|at| [0, 1, 2].map(|axis| hierarchy.corners[axis][at].to_bits()));
            found.push((face.id, corners.collect()));
        }
        found.sort();

        let corner = |at: u32| bits(scale.position(geometry.vertices[at as usize]));
        let mut expected: Vec<(u32, Vec<[u32; 3]>)> = Vec::new();
        expected.extend(geometry.triangles.iter().map(|of| (of.id.0, of.vertices.map(corner).to_vec())));
        expected.extend(geometry.spheres.iter().map(|of| {
            let radius = scale.length(of.radius);
            (of.id.0, vec![bits(scale.position(of.center)), [radius.to_bits(); 3]])
        }));
        expected
            .extend(geometry.polygons.iter().map(|of| (of.id.0, of.vertices.clone().map(corner).collect())));
        expected.sort();
        assert_eq!(found, expected, "seed {seed}");
    }
}

#[test]
fn nothing_is_hit_in_an_empty_scene() {
    let scene = super::scenes::scene_of(crate::scene::Geometry::default());
    let prepared = Prepared::new(&scene).unwrap();
    let random = &mut Random::new(1);
    for rays in [coherent(random, 70), shuffled(random, 70)] {
        assert_eq!(assert_same_as_all(&prepared, &rays, false).1, 0);
    }
}
