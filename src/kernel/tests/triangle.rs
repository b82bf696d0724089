//! Triangles in f32 against Möller and Trumbore's test in f64.

use super::sight::{self, Sight};
use super::{U, aimed, distance_from_edges, is_a_line, point, positive, reach, rounded, start, vector};
use crate::kernel::triangle;
use glam::DVec3;
use proptest::prelude::*;

#[derive(Clone, Copy, Debug)]
struct Case {
    ray: Sight,
    corners: [DVec3; 3],
}

fn case() -> impl Strategy<Value = Case> {
    let shape = (point(), positive(-20.0..1.0), [vector(-1.0..1.0), vector(-1.0..1.0), vector(-1.0..1.0)]);
    // Weights of the target: inside, on an edge, at a corner, or beyond them.
    let weights = prop_oneof![
        3 => [0.0..1.0, 0.0..1.0],
        1 => [-0.3..1.3, -0.3..1.3],
        1 => [Just(0.0).boxed(), (0.0..1.0).boxed()],
        1 => Just([0.0, 0.0]),
    ];
    // How near to its plane the ray runs.
    let grazing = prop_oneof![2 => Just(1.0), 1 => positive(-20.0..0.0)];
    (shape, weights, grazing).prop_flat_map(|((center, size, offsets), [v, w], grazing)| {
        let corners @ [a, b, c] = offsets.map(|offset| rounded(center + offset * size));
        let target = a + v * (b - a) + w * (c - a);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        start(center).prop_flat_map(move |from| {
            let from = from - (1.0 - grazing) * (from - target).dot(normal) * normal;
            aimed(from, target).prop_map(move |ray| Case { ray, corners })
        })
    })
}

struct Truth {
    t: f64,
    inside: bool,
    /// |cos| of the angle between ray and normal.
    cosine: f64,
}

/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997; none for a triangle seen edge-on.
fn moller_trumbore(ray: &Sight, [a, b, c]: [DVec3; 3]) -> Option<Truth> {
    let (o, d) = (ray.o(), ray.d());
    let (edge_1, edge_2) = (b - a, c - a);
    let p = d.cross(edge_2);
    let determinant = edge_1.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let from_a = o - a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(edge_1);
    let v = d.dot(q) / determinant;
    let cosine = determinant.abs() / (edge_1.cross(edge_2).length() * d.length());
    Some(Truth { t: edge_2.dot(q) / determinant, inside: u >= 0.0 && v >= 0.0 && u + v <= 1.0, cosine })
}

/// s²/h of a triangle with the longest edge s and the height h above it: no more than 4/3 of s where it is regular, and
/// large for a needle.
fn length_by_width([a, b, c]: &[DVec3; 3]) -> f64 {
    let longest = (*b - *a).length().max((*c - *b).length()).max((*a - *c).length());
    longest.powi(3) / (*b - *a).cross(*c - *a).length()
}

fn meet(case: &Case) -> triangle::Meeting<f32> {
    let space = sight::space::<f32>(&[case.ray]);
    let corners = case.corners.map(|corner| case.ray.axes().map(|axis| corner.as_vec3()[axis]));
    triangle::meet(&space, corners, 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn inside_is_what_the_textbook_says_away_from_edges(case in case()) {
        let clear = distance_from_edges(&case.ray, &case.corners) > 6.0 * U * reach(&case.ray, &case.corners);
        if let (true, Some(truth)) = (clear && !is_a_line(&case.ray, case.corners), moller_trumbore(&case.ray, case.corners)) {
            prop_assert_eq!(meet(&case).inside, truth.inside);
        }
    }

    #[test]
    fn t_is_within_its_bound_of_the_textbook_s(case in case()) {
        let found = meet(&case);
        if let (true, Some(truth)) = (found.inside, moller_trumbore(&case.ray, case.corners)) {
            let off = (f64::from(found.t(&sight::space(&[case.ray]))) - truth.t).abs() * case.ray.d().length();
            let bound = 6.0 * U * (reach(&case.ray, &case.corners) + length_by_width(&case.corners)) / truth.cosine;
            prop_assert!(off <= bound, "t is off by {off:e}, which is {} of the bound", off / bound);
        }
    }

    #[test]
    fn t_never_leaves_the_range_of_the_corners(case in case()) {
        let found = meet(&case);
        if found.inside {
            let third = case.ray.third();
            let t = case.corners.map(|corner| (corner - case.ray.o())[third] / case.ray.d()[third]);
            let (least, largest) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
            // The rounding of the mean itself.
            let slack = 8.0 * U * least.abs().max(largest.abs());
            let t = f64::from(found.t(&sight::space(&[case.ray])));
            prop_assert!(least - slack <= t && t <= largest + slack, "{t} is not between {least} and {largest}");
        }
    }

    /// The corners may be named in any order: what two triangles share they answer alike.
    #[test]
    fn inside_does_not_depend_on_the_order_of_the_corners(case in case()) {
        let [a, b, c] = case.corners;
        let expected = meet(&case).inside;
        for corners in [[b, c, a], [c, a, b], [c, b, a], [b, a, c], [a, c, b]] {
            let inside = meet(&Case { corners, ..case }).inside;
            // The area is a sum of three, so only its being 0 may turn on their order.
            prop_assert!(inside == expected || area_is_lost(&case), "{corners:?}");
        }
    }
}

fn area_is_lost(case: &Case) -> bool {
    moller_trumbore(&case.ray, case.corners).is_none_or(|truth| truth.cosine < 1e-3)
}
