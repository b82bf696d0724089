//! Spheres in f32 against the judge.

use super::sight::{self, Sight};
use super::{U, aimed, log_uniform, point, positive, rounded, single, start, vector};
use crate::certified::{self, Enclosure};
use crate::kernel::sphere;
use crate::lanes::Vector;
use glam::DVec3;
use proptest::prelude::*;

#[derive(Clone, Copy, Debug)]
struct Case {
    ray: Sight,
    center: DVec3,
    radius: f64,
}

fn case() -> impl Strategy<Value = Case> {
    // Rays pass the centre at this share of the radius: through the middle, anywhere, or at the limb.
    let share = prop_oneof![
        1 => Just(0.0),
        2 => 0.0..1.2,
        2 => log_uniform(-24.0..-2.0).prop_map(|off| 1.0 + off),
    ];
    (point(), positive(-18.0..1.0), share, vector(-1.0..1.0)).prop_flat_map(
        |(center, radius, share, side)| {
            let (center, radius) = (rounded(center), f64::from(single(radius)));
            start(center).prop_flat_map(move |from| {
                let side = side.reject_from(center - from + DVec3::splat(1e-30)).normalize_or_zero();
                let target = center + share * radius * side;
                aimed(from, target).prop_map(move |ray| Case { ray, center, radius })
            })
        },
    )
}

struct Truth {
    /// Distance of the centre from the line.
    off_center: f64,
    /// Half the chord as a length; 0 where there is none.
    half: f64,
    roots: Option<[Enclosure; 2]>,
}

fn truth(case: &Case) -> Truth {
    let roots = certified::sphere(&case.ray.judged(), case.center.as_vec3(), single(case.radius)).roots;
    Truth {
        off_center: case.ray.seen_along(case.center).length(),
        half: roots.map_or(0.0, |[near, far]| (far.low - near.high).max(0.0) / 2.0 * case.ray.d().length()),
        roots,
    }
}

fn meet(case: &Case) -> (sphere::Line<f32>, sphere::Meeting<f32>) {
    let line = sight::line::<f32>(&[case.ray]);
    let radius = single(case.radius);
    (line, sphere::meet(&line, Vector::splat(case.center.as_vec3().to_array()), radius * radius, 0.0))
}

/// How far l may be off, and the rounding of r².
fn slack(case: &Case) -> f64 {
    6.0 * U * (case.ray.o() - case.center).length() + U * case.radius
}

/// How far a root may be off, as a length: the middle of the chord by its own rounding, its half by what l is off.
fn root_slack(case: &Case, truth: &Truth) -> f64 {
    let middle = 4.0 * U * (case.ray.o() - case.center).length();
    let off = 2.0 * case.radius * slack(case);
    middle + (off / truth.half).min(off.sqrt()) + 2.0 * U * truth.half
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn lines_meet_a_sphere_where_they_do_in_truth_away_from_the_limb(case in case()) {
        let truth = truth(&case);
        if (truth.off_center - case.radius).abs() > slack(&case) {
            prop_assert_eq!(meet(&case).1.meets, truth.roots.is_some());
        }
    }

    #[test]
    fn both_roots_are_within_their_bound_of_the_truth(case in case()) {
        let (_, found) = meet(&case);
        let truth = truth(&case);
        if let (true, Some(roots)) = (found.meets, truth.roots) {
            let ts = [found.closest_t - found.half_t, found.closest_t + found.half_t];
            for (t, root) in ts.into_iter().zip(roots) {
                let off = root.distance(f64::from(t)) * case.ray.d().length();
                let bound = root_slack(&case, &truth);
                prop_assert!(off <= bound, "{t} for {root:?}: {} of the bound", off / bound);
            }
        }
    }

    #[test]
    fn the_nearest_root_is_the_smallest_above_zero(case in case()) {
        let (_, found) = meet(&case);
        let truth = truth(&case);
        if let (true, Some(roots)) = (found.meets, truth.roots) {
            let (t, hit) = found.nearest(0.0);
            let least = root_slack(&case, &truth) / case.ray.d().length();
            if roots.iter().all(|root| root.distance(0.0) > least) {
                let expected = roots.into_iter().find(|root| root.low > 0.0);
                prop_assert_eq!(hit, expected.is_some());
                if let Some(root) = expected {
                    prop_assert!(root.distance(f64::from(t)) <= least, "{t} for {root:?}");
                }
            }
        }
    }

    /// A root whose distance from the surface at the start, t·|d|·cos θ, is within slack / r touches.
    #[test]
    fn roots_within_the_slack_touch(case in case(), share in positive(-24.0..1.0)) {
        let (line, found) = meet(&case);
        let truth = truth(&case);
        if let (true, Some(roots)) = (found.meets, truth.roots) {
            let roots = roots.map(|root| root.middle());
            let slack = single(share * case.radius * case.radius);
            let length = case.ray.d().length();
            let height = |root: f64| (root * length * truth.half).abs() - f64::from(slack);
            let off = root_slack(&case, &truth);
            let unsure = off * (roots[1].abs() * length + truth.half + off) + 4.0 * U * f64::from(slack);
            if roots.iter().all(|&root| height(root).abs() > 2.0 * unsure) {
                let expected = roots.into_iter().any(|root| height(root) < 0.0);
                prop_assert_eq!(found.touches(&line, slack), expected);
            }
        }
    }

    /// From a point of the sphere the other end of the chord is found however short the chord.
    #[test]
    fn the_far_side_is_found_from_the_near_one(
        center in point(),
        radius in positive(-18.0..1.0),
        at in vector(-1.0..1.0),
        towards in vector(-1.0..1.0),
        tilt in positive(-18.0..0.0),
    ) {
        let (center, normal) = (rounded(center), at.normalize_or(DVec3::X));
        let along = towards.reject_from(normal).normalize_or(normal.any_orthonormal_vector());
        let ray = Sight::new(center + radius * normal, along - tilt * normal);
        let (o, d) = (ray.o() - center, ray.d());
        let expected = -2.0 * o.dot(d) / d.dot(d);
        let found = f64::from(meet(&Case { ray, center, radius: f64::from(single(radius)) }).1.far_side());
        // The rounding of o − c and of the product: nothing is lost to the difference of two roots.
        prop_assert!((found - expected).abs() * d.length() <= 12.0 * U * o.length(), "{found} for {expected}");
    }
}
