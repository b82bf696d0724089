//! What a candidate says of the error of its t is a bound on it: of triangles as thin as needles, of faces seen nearly edge-on,
//! and of spheres at their limbs. Which of two hits is nearer is decided in f64 only where these bounds overlap.

use super::Random;
use super::brute_force::Query;
use super::scenes::scene_of;
use crate::kernel::tests::sight::Sight;
use crate::kernel::tests::single;
use crate::prepare::Prepared;
use crate::scene::{Geometry, MaterialId, polygon_normal};
use crate::traverse::exact::ROUNDED;
use glam::{DVec3, Vec3};
use std::ops::Range;

/// t and its error as the engine has them, and the true t, of the one primitive of a scene; none where f32 does not decide that it
/// is hit. `truth` is given the ray in the scale of the prepared scene, and that scale.
fn candidate(
    geometry: Geometry,
    origin: DVec3,
    direction: DVec3,
    truth: impl Fn(&Sight, f64) -> f64,
) -> Option<[f64; 3]> {
    let scene = scene_of(geometry);
    let prepared = Prepared::new(&scene).unwrap();
    let scale = f64::from(prepared.scale.factor());
    let sight = Sight::new(scale * origin, direction.normalize());
    let hits = Query::new(sight).hits::<false>(&prepared.hierarchy);
    let &[(t, error, _)] = &hits[..] else { return None };
    // What f64 has decided has no more than its own rounding.
    if error == t * ROUNDED {
        return None;
    }
    Some([f64::from(t), f64::from(error), truth(&sight, scale)])
}

/// Where a ray meets a face's plane, but not before the face's box or beyond it: what is compared where bounds overlap.
fn truth_of_face(corners: &[Vec3]) -> impl Fn(&Sight, f64) -> f64 {
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let normal = polygon_normal(&corners).unwrap_or(DVec3::Z);
    let low = corners.iter().copied().reduce(DVec3::min).unwrap();
    let high = corners.iter().copied().reduce(DVec3::max).unwrap();
    move |sight, scale| {
        let (o, d) = (sight.o(), sight.d());
        let t = normal.dot(scale * corners[0] - o) / normal.dot(d);
        let [one, other] = [low, high].map(|plane| (scale * plane - o) / d);
        let (enter, leave) = (one.min(other).max_element(), one.max(other).min_element());
        t.min(leave).max(enter)
    }
}

/// Powers of two between which a test draws.
struct Powers {
    /// Of the length of a face.
    sizes: Range<f64>,
    /// Of its width over its length.
    widths: Range<f64>,
    /// Of the sine at which the ray meets it.
    tilts: Range<f64>,
}

/// A face of three corners or four, and a ray at it.
fn face(random: &mut Random, sides: usize, powers: &Powers) -> (Vec<Vec3>, [DVec3; 2]) {
    let Powers { sizes, widths, tilts } = powers;
    let [size, width, tilt] =
        [sizes, widths, tilts].map(|range| random.between(range.start, range.end).exp2());
    let along = random.vector().normalize();
    let across = random.vector().reject_from(along).normalize();
    let first = 0.5 * random.vector();
    let shear = random.unit();
    let places = [[0.0, 0.0], [1.0, 0.0], [1.0 + shear, width], [shear, width]];
    let places = if sides == 3 { vec![places[0], places[1], [shear, width]] } else { places.to_vec() };
    let corners: Vec<Vec3> =
        places.iter().map(|[x, y]| (first + size * (*x * along + *y * across)).as_vec3()).collect();
    let [a, b, c] = [0, 1, sides - 1].map(|corner| corners[corner].as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
    let (v, w) = (random.unit(), random.unit());
    let target = a + v * (b - a) + w * (1.0 - v) * (c - a);
    let way = random.vector().reject_from(normal).normalize() + tilt * normal;
    (corners, [target + random.between(0.1, 2.0) * way, -way])
}

/// Faces of a kind; returns how far off a t was, at most, in its own bound.
#[track_caller]
fn worst_of_faces(seed: u64, sides: usize, powers: &Powers) -> f64 {
    let (random, mut worst, mut hits) = (&mut Random::new(seed), 0.0_f64, 0);
    for _ in 0..200_000 {
        let (corners, [origin, direction]) = face(random, sides, powers);
        let mut geometry = Geometry::default();
        if sides == 3 {
            let first = geometry.add_vertices(corners.iter().copied()).unwrap();
            geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
        } else if geometry.add_polygon(&corners, None, MaterialId(0)).is_err() {
            continue;
        }
        if let Some([t, error, truth]) = candidate(geometry, origin, direction, truth_of_face(&corners)) {
            hits += 1;
            worst = worst.max((t - truth).abs() / error);
        }
    }
    assert!(hits > 20_000, "{hits} hits");
    worst
}

#[test]
fn needles_are_not_off_by_more_than_they_say() {
    let worst = worst_of_faces(1, 3, &Powers { sizes: -4.0..0.0, widths: -14.0..-4.0, tilts: -6.0..0.0 });
    assert!(worst > 0.02 && worst <= 1.0, "{worst} of the bound");
}

#[test]
fn triangles_seen_nearly_edge_on_are_not_off_by_more_than_they_say() {
    let worst = worst_of_faces(2, 3, &Powers { sizes: -4.0..0.0, widths: -1.0..0.0, tilts: -24.0..-10.0 });
    assert!(worst > 0.02 && worst <= 1.0, "{worst} of the bound");
}

/// Small and far away, so that their seen area is of the size of its rounding, and wider than t may be off.
#[test]
fn needles_seen_nearly_edge_on_are_not_off_by_more_than_they_say() {
    let worst = worst_of_faces(5, 3, &Powers { sizes: -12.0..-3.0, widths: -8.0..-1.0, tilts: -16.0..-3.0 });
    assert!(worst > 0.02 && worst <= 1.0, "{worst} of the bound");
}

#[test]
fn polygons_seen_nearly_edge_on_are_not_off_by_more_than_they_say() {
    let worst = worst_of_faces(3, 4, &Powers { sizes: -4.0..0.0, widths: -1.0..0.0, tilts: -24.0..0.0 });
    assert!(worst > 0.02 && worst <= 1.0, "{worst} of the bound");
}

#[test]
fn spheres_met_at_their_limbs_are_not_off_by_more_than_they_say() {
    let (random, mut worst, mut hits) = (&mut Random::new(4), 0.0_f64, 0);
    for _ in 0..200_000 {
        let center = random.vector().as_vec3();
        let radius = single(random.between(-14.0, 0.0).exp2());
        let wide = center.as_dvec3();
        let way = random.vector().normalize();
        let side = random.vector().reject_from(way).normalize();
        let off_limb = random.between(-24.0, 0.0).exp2();
        let target = wide + f64::from(radius) * (1.0 - off_limb) * side;
        let mut geometry = Geometry::default();
        geometry.add_sphere(center, radius, MaterialId(0)).unwrap();
        let truth = |sight: &Sight, scale: f64| {
            let from_center = sight.o() - scale * wide;
            let (d, radius) = (sight.d(), scale * f64::from(radius));
            let a = d.length_squared();
            let middle = -from_center.dot(d) / a;
            let off_center = (from_center + middle * d).length();
            let half = ((radius - off_center) * (radius + off_center) / a).max(0.0).sqrt();
            if middle - half > 0.0 { middle - half } else { middle + half }
        };
        if let Some([t, error, truth]) =
            candidate(geometry, target + random.between(0.1, 2.0) * way, -way, truth)
        {
            hits += 1;
            worst = worst.max((t - truth).abs() / error);
        }
    }
    assert!(hits > 20_000, "{hits} hits");
    assert!(worst > 0.02 && worst <= 1.0, "{worst} of the bound");
}
