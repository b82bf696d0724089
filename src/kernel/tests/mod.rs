//! What the kernels promise: the same bits in any lane, t and inside within their bounds of what the judge says, which is the
//! truth, and boxes that let through whatever is hit.

mod boxes;
mod hard;
mod polygon;
mod same_bits;
pub(crate) mod sight;
mod sphere;
mod textbook;
mod triangle;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use sight::Sight;

/// u, for bounds in f64.
const U: f64 = super::UNIT_ROUNDOFF as f64;

/// A number of either sign whose magnitude is anywhere between these powers of two, any power as likely.
fn log_uniform(powers: std::ops::Range<f64>) -> impl Strategy<Value = f64> + Clone {
    (powers, any::<bool>()).prop_map(|(power, negative)| if negative { -power.exp2() } else { power.exp2() })
}

fn positive(powers: std::ops::Range<f64>) -> impl Strategy<Value = f64> + Clone {
    log_uniform(powers).prop_map(f64::abs)
}

/// A coordinate of a scene whose largest lies in [1, 2): of any magnitude, or on a coarse grid, where zeros and equal
/// numbers are common.
fn coordinate() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        3 => log_uniform(-20.0..1.0),
        2 => (-4..=4_i8).prop_map(|step| f64::from(step) / 4.0),
        1 => prop::sample::select(&[0.0, -0.0][..]),
    ]
}

fn vector(each: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = DVec3> {
    [each.clone(), each.clone(), each].prop_map(DVec3::from)
}

fn point() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from)
}

/// Where a ray starts that is aimed at something around a point: anywhere in the scene or far outside it, or as near as
/// one likes.
fn start(around: DVec3) -> impl Strategy<Value = DVec3> {
    let near = (vector(-1.0..1.0), positive(-18.0..1.0)).prop_map(move |(off, size)| around + off * size);
    prop_oneof![2 => point(), 2 => near, 1 => vector(log_uniform(0.0..8.0))]
}

/// A ray from one point to another. Its direction has any length, or it lies along an axis through the target.
fn aimed(from: DVec3, at: DVec3) -> impl Strategy<Value = Sight> {
    let length = prop_oneof![1 => Just(0.0), 1 => -20.0..20.0_f64];
    let axis = prop_oneof![4 => Just(None), 1 => (0..3_usize).prop_map(Some)];
    let zeros = prop::sample::select(&[0.0, -0.0][..]);
    (length, axis, zeros).prop_map(move |(length, axis, zero)| {
        let along = at - from;
        let (origin, direction) = match axis {
            None => (from, along.normalize_or(DVec3::NEG_Y)),
            Some(axis) => {
                let (mut origin, mut direction) = (at, DVec3::splat(zero));
                (origin[axis], direction[axis]) = (from[axis], 1.0_f64.copysign(along[axis]));
                (origin, direction)
            }
        };
        Sight::new(origin, direction * length.exp2())
    })
}

/// As a scene would have it.
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
pub(crate) fn single(number: f64) -> f32 {
    number as f32
}

/// To f32 and back, as everything is that a kernel sees.
fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

/// |cos| of the angle between a ray and the normal of corners.
fn cosine(ray: &Sight, corners: &[DVec3]) -> f64 {
    let spanned = corners.windows(2).map(|edge| (edge[0] - corners[0]).cross(edge[1] - corners[0]));
    let normal = spanned.sum::<DVec3>().normalize_or_zero();
    normal.dot(ray.d().normalize()).abs()
}

/// Corners as the judge takes them.
fn singles(corners: &[DVec3]) -> Vec<Vec3> {
    corners.iter().map(|corner| corner.as_vec3()).collect()
}

/// The longest distance between two corners, rounded up to f32.
fn size(corners: &[DVec3]) -> f32 {
    let pairs = corners.iter().flat_map(|a| corners.iter().map(move |b| a.distance(*b)));
    single(pairs.fold(0.0, f64::max)).next_up()
}

/// Distance of the ray's line from a segment, in f64.
fn distance_from_segment(ray: &Sight, [a, b]: [DVec3; 2]) -> f64 {
    // Both ends as seen along the ray, which is at 0.
    let [a, b] = [a, b].map(|end| ray.seen_along(end));
    let along = b - a;
    let share =
        if along == DVec3::ZERO { 0.0 } else { (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    (a + share * along).length()
}

/// Edges of a closed loop of corners.
fn edges(corners: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&from, &to)| [from, to])
}

/// Distance of the ray's line from the nearest edge of a loop.
fn distance_from_edges(ray: &Sight, corners: &[DVec3]) -> f64 {
    edges(corners).map(|edge| distance_from_segment(ray, edge)).fold(f64::INFINITY, f64::min)
}

/// The largest distance of a corner from the ray's origin: L of the bounds.
fn reach(ray: &Sight, corners: &[DVec3]) -> f64 {
    corners.iter().map(|&corner| (corner - ray.o()).length()).fold(0.0, f64::max)
}

/// Whether a triangle is seen so nearly edge-on that f32 takes it for a line: then what lies on the line beyond its ends may
/// count as inside too.
fn is_a_line(ray: &Sight, corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| ray.seen_along(corner));
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let farthest = a.length().max(b.length()).max(c.length());
    let width = (b - a).cross(c - a).length() / longest;
    width < 4.0 * U * (reach(ray, &corners) + farthest * farthest / longest)
}
