//! What touches the surface that a ray starts on is not hit there, and what is a little way off is.

use super::Random;
use super::brute_force::Query;
use super::rays::{By, Walk};
use super::scenes::scene_of;
use crate::kernel::tests::sight::Sight;
use crate::kernel::tests::single;
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::scene::{Geometry, MaterialId, Scene};
use crate::traverse::NOTHING;
use glam::{DVec3, Vec3};

/// Three corners in a plane, around its point.
fn corners(point: DVec3, [x, y]: [DVec3; 2], size: f64) -> [Vec3; 3] {
    [x, y - x, -y - x].map(|corner| (point + size * corner).as_vec3())
}

/// The same ray from a point in f64.
fn starting(ray: &Query, start: DVec3) -> Query {
    let sight = Sight::new(start, ray.sight.d());
    Query { sight, origin_low: (start - sight.o()).as_vec3().to_array(), ..*ray }
}

/// The first hits of rays that start on primitive 0.
fn ids(scene: &Scene, rays: &[Query]) -> Vec<u32> {
    let prepared = Prepared::new(scene).unwrap();
    let factor = f64::from(prepared.scale.factor());
    let scaled = |ray: &Query| {
        let low = DVec3::from(ray.origin_low.map(f64::from));
        starting(ray, (ray.sight.o() + low) * factor)
    };
    let rays: Vec<Query> = rays.iter().map(scaled).collect();
    let walk =
        Walk { hierarchy: &prepared.hierarchy, rays: &rays, departing: true, any: false, by: By::Rows };
    Width::BEST.run(walk).id[..rays.len()].to_vec()
}

/// From points of a plane, rounded to f32, at angles down to nearly along it.
fn rays_from_plane(random: &mut Random, point: DVec3, [x, y]: [DVec3; 2], size: f64) -> Vec<Query> {
    let normal = x.cross(y).normalize();
    let rays = (0..64).map(|_| {
        let start = point + 0.3 * size * (random.between(-1.0, 1.0) * x + random.between(-0.3, 0.3) * y);
        let height = random.between(-8.0, 0.0).exp2() * if random.chance(0.5) { -1.0 } else { 1.0 };
        let along = (random.vector().reject_from(normal)).normalize();
        let sight = Sight::new(start, along + height * normal);
        Query { departure: 0, ..Query::new(sight) }
    });
    rays.collect()
}

/// Faces of one plane, to the last bit of their corners: triangles that begin with another corner, and a polygon.
#[test]
fn faces_in_the_plane_of_the_start_are_not_hit() {
    for seed in 0..300 {
        let random = &mut Random::new(seed);
        let (point, size) = (random.vector(), random.between(-10.0, 0.0).exp2());
        let x = random.vector().normalize();
        let plane = [x, random.vector().reject_from(x).normalize()];
        let mut geometry = Geometry::default();
        let [a, b, c] = corners(point, plane, size);
        for [a, b, c] in [[a, b, c], [b, c, a], [b, a, c]] {
            let first = geometry.add_vertices([a, b, c]).unwrap();
            geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
        }
        geometry.add_polygon(&[c, a, b], None, MaterialId(0)).unwrap();
        let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize();
        let rays: Vec<Query> = rays_from_plane(random, point, plane, size)
            .iter()
            .map(|ray| starting(ray, ray.sight.o() - (ray.sight.o() - a).dot(normal) * normal))
            .collect();
        let found = ids(&scene_of(geometry), &rays);
        assert!(found.iter().all(|&id| id == NOTHING), "seed {seed}: {found:?}");
    }
}

/// A face above the plane by some ten thousandths of its size is hit by the rays that go there.
#[test]
fn faces_a_little_above_the_start_are_hit() {
    for (seed, sides) in (0..200).zip([3, 4].into_iter().cycle()) {
        let random = &mut Random::new(seed);
        let point = random.vector();
        let x = random.vector().normalize();
        let plane = [x, random.vector().reject_from(x).normalize()];
        let normal = plane[0].cross(plane[1]);
        let mut geometry = Geometry::default();
        for off in [DVec3::ZERO, 1e-5 * normal] {
            let [a, b, c] = corners(point + off, plane, 1.0);
            if sides == 3 {
                let first = geometry.add_vertices([a, b, c]).unwrap();
                geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
            } else {
                geometry.add_polygon(&[a, b, b.lerp(c, 0.5), c], None, MaterialId(0)).unwrap();
            }
        }
        let rays = rays_from_plane(random, point, plane, 0.3);
        let found = ids(&scene_of(geometry), &rays);
        for (ray, id) in rays.iter().zip(found) {
            let expected = if ray.sight.d().dot(normal) > 0.0 { 1 } else { NOTHING };
            assert_eq!(id, expected, "seed {seed}, {ray:?}");
        }
    }
}

/// The same sphere twice: outward nothing is hit, inward the far wall, of which the smaller id counts.
#[test]
fn a_sphere_on_a_sphere_is_met_at_the_far_wall_alone() {
    for seed in 0..300 {
        let random = &mut Random::new(seed);
        let (center, radius) = (random.vector().as_vec3(), single(random.between(-10.0, 0.0).exp2()));
        let mut geometry = Geometry::default();
        for _ in 0..2 {
            geometry.add_sphere(center, radius, MaterialId(0)).unwrap();
        }
        let rays: Vec<Query> = (0..64)
            .map(|_| {
                let normal = random.vector().normalize();
                let inward = random.chance(0.5);
                let height = random.between(-5.0, 0.0).exp2() * if inward { -1.0 } else { 1.0 };
                let along = random.vector().reject_from(normal).normalize();
                let start = center.as_dvec3() + f64::from(radius) * normal;
                let sight = Sight::new(start, along + height * normal);
                // The other one, so that the one that is not the ray's own has the smaller id.
                starting(&Query { departure: 2 + u32::from(inward), ..Query::new(sight) }, start)
            })
            .collect();
        for (ray, id) in rays.iter().zip(ids(&scene_of(geometry), &rays)) {
            let is_inside = if ray.departure % 2 == 1 { id != NOTHING } else { id == NOTHING };
            assert!(is_inside, "seed {seed}: {id} by {ray:?}");
        }
    }
}
