//! The reference's own rounding, judged.
//!
//! Its formulas round as those of an engine in f32 do, with u = 2⁻⁵³ instead of 2⁻²⁴: an outline or a limb is decided right if the ray
//! passes it by more than 6uL, L the farthest point of the primitive from the ray's start; t is off by no more than 6u(L + s²/h)/cos θ
//! of a triangle with the longest edge s and the height h above it, and of a polygon, whose normal is rounded as it is summed over m
//! corners of an extent s around an area A, by no more than 8u(L + m·s³/A)/cos θ. Of all but needles that is less than the 2⁻⁴⁶ of the
//! coordinates that [`Meeting::uncertainty`] claims, which is tested as well.

use super::ray::Ray;
use super::shape::{Meeting, Primitive};
use crate::certified::{self, Enclosure, Limb, Line, Seen};
use crate::scene::{Geometry, Material, MaterialId};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// 2⁻⁵³.
const U: f64 = f64::EPSILON / 2.0;

/// Of any magnitude from 2⁻¹⁶ to 2, or on a grid of quarters.
fn coordinate() -> impl Strategy<Value = f64> + Clone {
    let any = (-16.0..1.0_f64, any::<bool>());
    prop_oneof![
        2 => any.prop_map(|(power, negative)| if negative { -power.exp2() } else { power.exp2() }),
        1 => (-8..=8_i8).prop_map(|step| f64::from(step) / 4.0),
    ]
}

fn point() -> impl Strategy<Value = DVec3> + Clone {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from)
}

fn single(point: DVec3) -> Vec3 {
    point.as_vec3()
}

/// From somewhere to a place, past it by so many roundings of f64 as a power of two says.
fn past(place: DVec3) -> impl Strategy<Value = Line> {
    (point(), point(), -2.0..24.0_f64, any::<bool>(), -8.0..8.0_f64).prop_filter_map(
        "a line needs a direction",
        move |(origin, aside, power, exactly, length)| {
            let off = if exactly { 0.0 } else { power.exp2() * U };
            let direction = (place + off * aside - origin) * length.exp2();
            (direction != DVec3::ZERO).then_some(Line { origin, direction })
        },
    )
}

/// Three to seven corners around a point in a plane, and a line past an edge, a corner or a point between.
fn at_face(corners: std::ops::Range<usize>) -> impl Strategy<Value = (Line, Vec<Vec3>)> {
    let shape = (point(), point(), point(), prop::collection::vec(0.3..1.0_f64, corners), -10.0..0.0_f64);
    let at = any::<prop::sample::Index>();
    let share = prop_oneof![Just(0.0), Just(0.5), 0.0..1.0_f64];
    (shape, at.clone(), at, share).prop_flat_map(|((center, normal, side, distances, size), a, b, share)| {
        let normal = normal.normalize_or(DVec3::Z);
        let x = side.reject_from(normal).normalize_or(normal.any_orthonormal_vector());
        let y = normal.cross(x);
        let count = distances.len();
        let corner = |index: usize| {
            let (sin, cos) = (std::f64::consts::TAU * index as f64 / count as f64).sin_cos();
            single(center + size.exp2() * distances[index] * (cos * x + sin * y))
        };
        let corners: Vec<Vec3> = (0..count).map(corner).collect();
        let [a, b] = [a, b].map(|at| corners[at.index(count)].as_dvec3());
        past(a.lerp(b, share)).prop_map(move |line| (line, corners.clone()))
    })
}

fn at_sphere() -> impl Strategy<Value = (Line, Vec3, f32)> {
    (point(), -12.0..1.0_f32, point(), prop_oneof![Just(1.0), 0.0..1.2_f64]).prop_flat_map(
        |(center, size, side, share)| {
            let (center, radius) = (single(center), size.exp2());
            let limb = center.as_dvec3() + share * f64::from(radius) * side.normalize_or(DVec3::X);
            past(limb).prop_map(move |line| (line, center, radius))
        },
    )
}

fn only(geometry: &Geometry) -> Option<Primitive> {
    Primitive::all(geometry, &[Material::grey()]).pop()
}

fn face(corners: &[Vec3]) -> Option<Primitive> {
    let mut geometry = Geometry::default();
    match corners {
        [_, _, _] => {
            let first = geometry.add_vertices(corners.iter().copied()).unwrap();
            geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
        }
        _ => {
            // What rounding to f32 has bent too far, a polygon of the size of its coordinates' last digits, is none.
            geometry.add_polygon(corners, None, MaterialId(0)).ok()?;
        }
    }
    only(&geometry)
}

fn met(line: &Line, primitive: &Primitive) -> Option<Meeting> {
    primitive.intersect(&Ray::new(line.origin, line.direction, None))
}

/// What a face makes of its bounds.
struct Face {
    /// L.
    farthest: f64,
    /// s³/A, A half the length of Newell's sum, or s²/h.
    tilt: f64,
    /// |cos θ|.
    cosine: f64,
    /// Of the line from the nearest edge.
    to_edge: f64,
}

fn measured(line: &Line, corners: &[Vec3]) -> Face {
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let direction = line.direction.normalize();
    let sum: DVec3 = corners.windows(2).map(|edge| (edge[0] - corners[0]).cross(edge[1] - corners[0])).sum();
    let size = corners.iter().flat_map(|a| corners.iter().map(move |b| a.distance(*b))).fold(0.0, f64::max);
    let seen: Vec<DVec3> =
        corners.iter().map(|&corner| (corner - line.origin).reject_from_normalized(direction)).collect();
    let to_edge = |(a, b): (&DVec3, &DVec3)| {
        let along = *b - *a;
        let share = (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        if share.is_nan() { a.length() } else { (*a + share * along).length() }
    };
    Face {
        farthest: corners.iter().map(|corner| corner.distance(line.origin)).fold(0.0, f64::max),
        tilt: size.powi(3) / sum.length(),
        cosine: sum.normalize().dot(direction).abs(),
        to_edge: seen.iter().zip(seen.iter().cycle().skip(1)).map(to_edge).fold(f64::INFINITY, f64::min),
    }
}

/// Decisions beyond 6uL and what the distance itself is off by, t within a length, and both within what the reference claims.
fn assert_face(line: &Line, corners: &[Vec3], t_off: impl Fn(&Face) -> f64) -> Result<(), TestCaseError> {
    let Some(primitive) = face(corners) else { return Ok(()) };
    let meeting = match corners {
        &[a, b, c] => certified::triangle(line, [a, b, c]),
        _ => certified::polygon(line, corners),
    };
    let face = measured(line, corners);
    let speed = line.direction.length();
    let bound = t_off(&face) / (face.cosine * speed);
    let found = met(line, &primitive);
    let ahead = |t: Enclosure| t.low > bound;
    let behind = |t: Enclosure| t.high < -bound;
    if face.to_edge > 16.0 * U * face.farthest
        && meeting.seen != Seen::EdgeOn
        && !meeting.t.is_some_and(|t| !ahead(t) && !behind(t))
    {
        prop_assert_eq!(found.is_some(), meeting.t.is_some_and(ahead), "{:?}", meeting);
    }
    if let (Some(found), Some(expected)) = (found, certified::plane_t(line, corners)) {
        let off = expected.distance(found.t);
        prop_assert!(off <= bound, "t is off by {off:e}, {} of the bound", off / bound);
        if face.tilt < 8.0 * face.farthest {
            prop_assert!(
                off <= found.uncertainty,
                "{off:e} is more than is claimed, {:e}",
                found.uncertainty
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn triangles_are_met_within_the_rounding_of_f64((line, corners) in at_face(3..4)) {
        assert_face(&line, &corners, |face| 6.0 * U * (face.farthest + face.tilt))?;
    }

    #[test]
    fn polygons_are_met_within_the_rounding_of_f64((line, corners) in at_face(4..8)) {
        let count = corners.len() as f64;
        assert_face(&line, &corners, |face| 8.0 * U * (face.farthest + count * face.tilt))?;
    }

    #[test]
    fn spheres_are_met_within_the_rounding_of_f64((line, center, radius) in at_sphere()) {
        let mut geometry = Geometry::default();
        geometry.add_sphere(center, radius, MaterialId(0)).unwrap();
        let found = met(&line, &only(&geometry).unwrap());
        let truth = certified::sphere(&line, center, radius);
        let (to_center, radius) = (center.as_dvec3() - line.origin, f64::from(radius));
        let direction = line.direction.normalize();
        let (distance, off_center) = (to_center.length(), to_center.reject_from_normalized(direction).length());
        let speed = line.direction.length();
        // As for f32: the middle of the chord by its own rounding, its half by what its distance from the centre is off.
        let slack = 2.0 * radius * U * (6.0 * distance + radius);
        let half = truth.roots.map_or(0.0, |[near, far]| (far.middle() - near.middle()) / 2.0 * speed);
        let bound = (4.0 * U * distance + (slack / half).min(slack.sqrt()) + 2.0 * U * half) / speed;
        let near_limb = (off_center - radius).abs() <= 16.0 * U * (distance + radius);
        let first = truth.roots.and_then(|roots| roots.into_iter().find(|root| root.low > 0.0));
        let near_start = truth.roots.is_some_and(|roots| roots.iter().any(|root| root.distance(0.0) <= bound));
        if !near_limb && !near_start {
            prop_assert_eq!(found.is_some(), first.is_some(), "{:?}", truth);
        }
        if let (Some(found), Some(first), false) = (found, first, near_start) {
            let off = first.distance(found.t);
            prop_assert!(off <= bound, "t is off by {off:e}, {} of the bound, {:?}", off / bound, truth.limb);
            prop_assert!(off <= found.uncertainty || truth.limb == Limb::Touched || half < 1e-4 * radius, "{off:e} is more than is claimed, {:e}", found.uncertainty);
        }
    }
}
