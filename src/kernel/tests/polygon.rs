//! The crossing-number test in f32 against the judge.

use super::sight::{self, Sight};
use super::{
    U, aimed, cosine, distance_from_edges, edges, point, positive, reach, rounded, single, singles, size,
    start, vector,
};
use crate::certified::{self, Seen};
use crate::kernel::polygon::{self, Outline};
use crate::kernel::unclear_area;
use crate::lanes::Vector;
use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::TAU;

#[derive(Clone, Debug)]
struct Case {
    ray: Sight,
    corners: Vec<DVec3>,
}

/// Corners around a point in a random plane. Their distances from it differ, so that most outlines are concave; with a
/// step that skips corners they cross themselves.
fn corners() -> impl Strategy<Value = Vec<DVec3>> {
    let shape = (point(), positive(-16.0..0.0), vector(-1.0..1.0), vector(-1.0..1.0));
    let distances = prop::collection::vec(prop_oneof![2 => 0.2..1.0, 1 => Just(1.0)], 3..20);
    (shape, distances, prop_oneof![3 => Just(1), 1 => 1..4_usize]).prop_map(
        |((center, size, normal, side), distances, step)| {
            let normal = normal.normalize_or(DVec3::Z);
            let x = side.reject_from(normal).normalize_or(normal.any_orthonormal_vector());
            let y = normal.cross(x);
            let count = distances.len();
            let corner = |at: usize| {
                let (sin, cos) = (TAU * (at * step) as f64 / count as f64).sin_cos();
                rounded(center + size * distances[at] * (cos * x + sin * y))
            };
            (0..count).map(corner).collect()
        },
    )
}

fn case() -> impl Strategy<Value = Case> {
    let share = prop_oneof![3 => -0.2..1.2, 2 => Just(0.0), 1 => Just(0.5)];
    let grazing = prop_oneof![2 => Just(1.0), 1 => positive(-20.0..0.0)];
    (corners(), [any::<prop::sample::Index>(), any::<prop::sample::Index>()], share, grazing).prop_flat_map(
        |(corners, ends, share, grazing)| {
            let [a, b] = ends.map(|end| corners[end.index(corners.len())]);
            let target = a.lerp(b, share);
            let normal = newell(&corners);
            start(target).prop_flat_map(move |from| {
                let from = from - (1.0 - grazing) * (from - target).dot(normal) * normal;
                let corners = corners.clone();
                aimed(from, target).prop_map(move |ray| Case { ray, corners: corners.clone() })
            })
        },
    )
}

fn newell(corners: &[DVec3]) -> DVec3 {
    let sum: DVec3 = edges(corners).map(|[from, to]| (from - corners[0]).cross(to - corners[0])).sum();
    sum.normalize_or(DVec3::Z)
}

fn outline(ray: &Sight, corners: &[DVec3]) -> Outline<f32> {
    let space = sight::space::<f32>(&[*ray]);
    let seen = |corner: DVec3| space.see(ray.axes().map(|axis| corner.as_vec3()[axis]));
    let mut outline = Outline::new();
    for [from, to] in edges(corners) {
        outline.add_edge(&seen(from), &seen(to), 0.0);
    }
    outline
}

fn seen(ray: &Sight, corners: &[DVec3]) -> Seen {
    certified::polygon(&ray.judged(), &singles(corners)).seen
}

fn meet_plane(ray: &Sight, corners: &[DVec3]) -> polygon::Meeting<f32> {
    let space = sight::space::<f32>(&[*ray]);
    let line = sight::line::<f32>(&[*ray]);
    let outline = outline(ray, corners);
    let corner_ts = [outline.least_z * space.t_per_z, outline.largest_z * space.t_per_z];
    let plane = [corners[0], newell(corners)].map(|vector| Vector::splat(vector.as_vec3().to_array()));
    polygon::meet_plane(&line, plane, corner_ts, 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn an_odd_number_of_crossings_is_the_truth_away_from_edges(case in case()) {
        let Case { ray, corners } = &case;
        let seen = seen(ray, corners);
        if seen != Seen::EdgeOn && distance_from_edges(ray, corners) > 6.0 * U * reach(ray, corners) {
            prop_assert_eq!(outline(ray, corners).odd, seen == Seen::Inside);
        }
    }

    /// However near to an edge.
    #[test]
    fn what_is_clear_is_the_truth(case in case()) {
        let Case { ray, corners } = &case;
        let space = sight::space::<f32>(&[*ray]);
        let from_ray = |corner: DVec3| space.see(ray.axes().map(|axis| corner.as_vec3()[axis]));
        let longest_edge = edges(corners).map(|[from, to]| from.distance(to)).fold(0.0, f64::max);
        let unclear_area = unclear_area(&from_ray(corners[0]), [size(corners), single(longest_edge)]);
        let mut outline = Outline::<f32>::new();
        for [from, to] in edges(corners) {
            outline.add_edge_with_doubt(&from_ray(from), &from_ray(to), (unclear_area, true), 0.0);
        }
        let seen = seen(ray, corners);
        if seen != Seen::EdgeOn && !outline.unclear {
            prop_assert_eq!(outline.odd, seen == Seen::Inside);
            prop_assert!(!seen.is_boundary());
        }
    }

    #[test]
    fn t_is_within_its_bound_of_the_truth_and_between_the_corners(case in case()) {
        let Case { ray, corners } = &case;
        let found = meet_plane(ray, corners);
        let third = ray.third();
        let ts: Vec<f64> = corners.iter().map(|&corner| (corner - ray.o())[third] / ray.d()[third]).collect();
        let (least, largest) =
            (ts.iter().copied().fold(f64::INFINITY, f64::min), ts.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        let slack = 4.0 * U * least.abs().max(largest.abs());
        let t = f64::from(found.t);
        let expected = certified::polygon(&ray.judged(), &singles(corners)).t;
        if let (true, Some(expected)) = (found.meets, expected) {
            prop_assert!(least - slack <= t && t <= largest + slack, "{t} is not between {least} and {largest}");
            let off = expected.distance(t) * ray.d().length();
            let bound = 6.0 * U * reach(ray, corners) / cosine(ray, corners);
            prop_assert!(off <= bound, "t is off by {off:e}, which is {} of the bound", off / bound);
        }
    }

    #[test]
    fn the_height_is_that_of_the_origin_above_the_plane(case in case()) {
        let Case { ray, corners } = &case;
        let expected = newell(corners).dot(corners[0] - ray.o());
        let off = (f64::from(meet_plane(ray, corners).height) - expected).abs();
        prop_assert!(off <= 6.0 * U * reach(ray, corners), "{off:e}");
    }

    /// Two parts of a polygon claim a ray together exactly if the whole does: also a ray through the cut, its ends, an edge
    /// or a corner. Where the whole claims it, one of the parts does, and not both.
    #[test]
    fn parts_of_a_polygon_share_out_its_rays(
        case in case(),
        ends in [any::<prop::sample::Index>(), any::<prop::sample::Index>()],
        share in prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0..1.0],
        from in point(),
    ) {
        let corners = &case.corners;
        let [one, other] = ends.map(|end| end.index(corners.len()));
        let (first, last) = (one.min(other), one.max(other));
        let through_cut = corners[first].lerp(corners[last], share) - from;
        prop_assume!(through_cut != DVec3::ZERO);
        let part: Vec<DVec3> = corners[first..=last].to_vec();
        let rest: Vec<DVec3> = corners[last..].iter().chain(&corners[..=first]).copied().collect();
        for ray in [case.ray, Sight::new(from, through_cut)] {
            let [whole, part, rest] =
                [corners, &part, &rest].map(|corners: &Vec<DVec3>| outline(&ray, corners).odd);
            prop_assert_eq!(whole, part != rest);
        }
    }

    /// Where the corners start and which way they go round is the same to a ray.
    #[test]
    fn an_outline_can_be_walked_from_any_corner_either_way(case in case(), start in any::<prop::sample::Index>()) {
        let Case { ray, mut corners } = case;
        let expected = outline(&ray, &corners);
        let start = start.index(corners.len());
        corners.rotate_left(start);
        corners.reverse();
        let found = outline(&ray, &corners);
        prop_assert_eq!(
            (found.odd, found.least_z, found.largest_z),
            (expected.odd, expected.least_z, expected.largest_z)
        );
    }
}

/// Corners level with the foot of the ray, edges along its half-line, and the foot on corners and edges.
#[test]
fn a_grid_of_rays_hits_a_grid_of_squares_once_each() {
    let corner = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
    let squares: Vec<Vec<DVec3>> = (0..8)
        .flat_map(|x| {
            (0..8).map(move |y| vec![corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)])
        })
        .collect();
    for (x, y) in (2..=14).flat_map(|x| (2..=14).map(move |y| (f64::from(x) / 2.0, f64::from(y) / 2.0))) {
        for direction in [
            DVec3::NEG_Z,
            DVec3::new(-0.0, 0.0, -3.0),
            DVec3::new(0.25, 0.0, -1.0),
            DVec3::new(0.5, -0.25, -1.0),
        ] {
            let ray = Sight::new(DVec3::new(x, y, 0.0) - direction, direction);
            let hits = squares.iter().filter(|square| outline(&ray, square).odd).count();
            assert_eq!(hits, 1, "at ({x}, {y}) along {direction}");
        }
    }
}
