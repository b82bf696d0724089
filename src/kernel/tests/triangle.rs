//! Triangles in f32 against the judge.

use super::sight::{self, Sight};
use super::{
    U, aimed, cosine, distance_from_edges, is_a_line, log_uniform, point, positive, reach, rounded, singles,
    size, start, vector,
};
use crate::certified::{self, FaceMeeting, Seen};
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

fn truth(case: &Case) -> FaceMeeting {
    certified::triangle(&case.ray.judged(), case.corners.map(DVec3::as_vec3))
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
    triangle::meet(&space, corners)
}

/// What a start's rounding to f32 left out, as a share of it.
fn low() -> impl Strategy<Value = DVec3> {
    prop_oneof![1 => Just(DVec3::ZERO), 3 => vector(-0.5..0.5)].prop_map(|share| share * 2.0 * U)
}

/// A ray that starts next to a point inside of a triangle, above it or below by any power of two.
fn from_the_surface() -> impl Strategy<Value = Case> {
    let weights = [0.05..0.45, 0.05..0.45_f64];
    let shape = (point(), positive(-12.0..1.0), [vector(-1.0..1.0), vector(-1.0..1.0), vector(-1.0..1.0)]);
    (shape, weights, log_uniform(-34.0..-4.0), vector(-1.0..1.0)).prop_map(
        |((center, size, offsets), [v, w], height, direction)| {
            let corners @ [a, b, c] = offsets.map(|offset| rounded(center + offset * size));
            let normal = (b - a).cross(c - a).normalize_or(DVec3::X);
            let start = a + v * (b - a) + w * (c - a) + height * size * normal;
            Case { ray: Sight::new(start, direction + 1e-3 * normal), corners }
        },
    )
}

/// What the kernel and the judge find from a start that has a low part, and the kernel's t.
fn from_start(case: &Case, low: DVec3) -> (triangle::Meeting<f32>, FaceMeeting, f32) {
    let low = (low * case.ray.o()).as_vec3();
    let axes = case.ray.axes();
    let mut space = sight::space::<f32>(&[case.ray]);
    space.origin_low = Some(axes.map(|axis| low[axis]));
    let corners = case.corners.map(DVec3::as_vec3);
    let found = triangle::meet(&space, corners.map(|corner| axes.map(|axis| corner[axis])));
    let mut line = case.ray.judged();
    line.origin += low.as_dvec3();
    let t = found.t(&space);
    (found, certified::triangle(&line, corners), t)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn inside_is_the_truth_away_from_edges(case in case()) {
        let clear = distance_from_edges(&case.ray, &case.corners) > 6.0 * U * reach(&case.ray, &case.corners);
        if clear && !is_a_line(&case.ray, case.corners) {
            prop_assert_eq!(meet(&case).inside(0.0), truth(&case).seen == Seen::Inside);
        }
    }

    /// However near to an edge, and from a start of more digits than f32 has.
    #[test]
    fn what_is_inside_for_certain_is_inside_and_what_cannot_be_is_not(case in case(), low in low()) {
        let (found, truth, _) = from_start(&case, low);
        let (may_be, is_certain) = found.may_be_inside(size(&case.corners));
        let seen = truth.seen;
        prop_assert!(!is_certain || seen == Seen::Inside, "certain, and {seen:?}");
        prop_assert!(may_be || !(seen == Seen::Inside || seen.is_boundary()), "impossible, and {seen:?}");
    }

    #[test]
    fn t_is_within_its_bound_of_the_truth(case in case()) {
        let found = meet(&case);
        let plane = certified::plane_t(&case.ray.judged(), &singles(&case.corners));
        if let (true, Some(expected)) = (found.inside(0.0), plane) {
            let off = expected.distance(f64::from(found.t(&sight::space(&[case.ray])))) * case.ray.d().length();
            let cosine = cosine(&case.ray, &case.corners);
            let bound = 6.0 * U * (reach(&case.ray, &case.corners) + length_by_width(&case.corners)) / cosine;
            prop_assert!(off <= bound, "t is off by {off:e}, which is {} of the bound", off / bound);
        }
    }

    /// However near to the plane the ray starts.
    #[test]
    fn the_side_of_the_start_is_right_where_it_does_not_touch(case in from_the_surface(), low in low()) {
        let (found, truth, t) = from_start(&case, low);
        if let (false, Seen::Inside, Some(expected)) = (found.touches(size(&case.corners)), truth.seen, truth.t) {
            prop_assert!(expected.low > 0.0 || expected.high < 0.0, "the start is in the plane");
            if found.may_be_inside(size(&case.corners)).1 {
                prop_assert_eq!(t > 0.0, expected.low > 0.0);
            }
        }
    }

    #[test]
    fn t_never_leaves_the_range_of_the_corners(case in case()) {
        let found = meet(&case);
        if found.inside(0.0) {
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
        let expected = meet(&case).inside(0.0);
        for corners in [[b, c, a], [c, a, b], [c, b, a], [b, a, c], [a, c, b]] {
            let inside = meet(&Case { corners, ..case }).inside(0.0);
            // The area is a sum of three, so only its being 0 may turn on their order.
            prop_assert!(inside == expected || area_is_lost(&case), "{corners:?}");
        }
    }
}

fn area_is_lost(case: &Case) -> bool {
    cosine(&case.ray, &case.corners) < 1e-3
}
