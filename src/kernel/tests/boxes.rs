//! The box of a primitive lets through every ray that the primitive's own test hits: so which boxes are visited never
//! shows.

use super::sight::{self, Sight};
use super::{aimed, is_a_line, log_uniform, point, positive, rounded, single, start, vector};
use crate::certified::{self, BoxMeeting};
use crate::kernel::polygon::{self, Outline};
use crate::kernel::{bounds, sphere, triangle};
use crate::lanes::Vector;
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// A box as the hierarchy has it, with the smallest padding that a scene with this primitive can lead to. Returns where the
/// ray enters it.
fn enters(ray: &Sight, [low, high]: [Vec3; 2]) -> Result<f32, TestCaseError> {
    let extent = low.abs().max(high.abs()).max_element();
    let slabs = sight::slabs::<f32>(&[*ray], extent);
    let [near, far] = sight::planes(&[*ray], &[[low.to_array(), high.to_array()]]);
    let (enter, meets) = bounds::enter(&slabs, near, far, 0.0, f32::INFINITY);
    prop_assert!(meets && enter >= 0.0, "hit, but the box is entered at {enter:e} and left before");
    Ok(enter)
}

fn bounds_of(corners: &[DVec3]) -> [Vec3; 2] {
    let corners = corners.iter().map(|corner| corner.as_vec3());
    [corners.clone().fold(Vec3::INFINITY, Vec3::min), corners.fold(Vec3::NEG_INFINITY, Vec3::max)]
}

/// Corners in a plane, and a ray at a corner, an edge point or a point between.
fn flat() -> impl Strategy<Value = (Sight, Vec<DVec3>)> {
    let size = prop_oneof![1 => positive(-20.0..1.0), 1 => Just(0.5)];
    let plane = prop_oneof![
        2 => [vector(-1.0..1.0).boxed(), vector(-1.0..1.0).boxed()],
        // Flat boxes.
        1 => prop::sample::select(vec![[DVec3::X, DVec3::Y], [DVec3::Y, DVec3::Z], [DVec3::Z, DVec3::X]])
            .prop_flat_map(|[x, y]| [Just(x).boxed(), Just(y).boxed()]),
    ];
    let on_plane = prop::collection::vec([-1.0..1.0, -1.0..1.0], 3..8);
    let weights = prop_oneof![1 => Just([0.0, 0.0]), 2 => [Just(0.0).boxed(), (0.0..1.0).boxed()], 2 => [0.0..1.0, 0.0..1.0]];
    let grazing = prop_oneof![3 => Just(1.0), 1 => positive(-30.0..0.0)];
    (point(), size, plane, on_plane, weights, grazing).prop_flat_map(
        |(center, size, [x, y], on_plane, [v, w], grazing)| {
            let corners: Vec<DVec3> =
                on_plane.iter().map(|&[a, b]: &[f64; 2]| rounded(center + size * (a * x + b * y))).collect();
            let target =
                corners[0] + v * (corners[1] - corners[0]) + w * (1.0 - v) * (corners[2] - corners[0]);
            let normal = x.cross(y).normalize_or_zero();
            start(center).prop_flat_map(move |from| {
                let from = from - (1.0 - grazing) * (from - target).dot(normal) * normal;
                let corners = corners.clone();
                aimed(from, target).prop_map(move |ray| (ray, corners.clone()))
            })
        },
    )
}

fn ball() -> impl Strategy<Value = (Sight, DVec3, f32)> {
    let share =
        prop_oneof![1 => 0.0..1.0, 3 => log_uniform(-26.0..-8.0).prop_map(|off| 1.0 + off), 1 => Just(1.0)];
    // The limb as seen along an axis is where the box is touched.
    let side = prop_oneof![
        1 => vector(-1.0..1.0),
        1 => prop::sample::select(vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z]),
    ];
    (point(), positive(-20.0..1.0), share, side).prop_flat_map(|(center, radius, share, side)| {
        let (center, radius, side) = (rounded(center), single(radius), side.normalize_or_zero());
        let target: DVec3 = center + f64::from(radius) * share * side;
        start(center).prop_flat_map(move |from| {
            let perpendicular = from - (from - target).dot(side) * side;
            prop_oneof![aimed(from, target), aimed(perpendicular, target)]
                .prop_map(move |ray| (ray, center, radius))
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40_000))]

    #[test]
    fn the_box_of_a_triangle_lets_its_hits_through((ray, corners) in flat()) {
        let corners = &corners[..3];
        let space = sight::space::<f32>(&[ray]);
        let turned = [0, 1, 2].map(|at| ray.axes().map(|axis| corners[at].as_vec3()[axis]));
        let found = triangle::meet(&space, turned);
        // What only looks like a hit is left to the box.
        let is_real = !is_a_line(&ray, [corners[0], corners[1], corners[2]]);
        if found.inside(0.0) && found.t(&space) > 0.0 && is_real {
            enters(&ray, bounds_of(corners))?;
        }
    }

    #[test]
    fn the_box_of_a_polygon_lets_its_hits_through((ray, corners) in flat()) {
        let space = sight::space::<f32>(&[ray]);
        let line = sight::line::<f32>(&[ray]);
        let seen = |corner: DVec3| space.see(ray.axes().map(|axis| corner.as_vec3()[axis]));
        let mut outline = Outline::<f32>::new();
        for [from, to] in super::edges(&corners) {
            outline.add_edge(&seen(from), &seen(to), 0.0);
        }
        let normal = crate::scene::polygon_normal(&corners).unwrap_or(DVec3::Z);
        let plane = [corners[0], normal].map(|vector| Vector::splat(vector.as_vec3().to_array()));
        let corner_ts = [outline.least_z * space.t_per_z, outline.largest_z * space.t_per_z];
        let found = polygon::meet_plane(&line, plane, corner_ts, 0.0);
        if outline.odd && found.meets && found.t > 0.0 {
            enters(&ray, bounds_of(&corners))?;
        }
    }

    #[test]
    fn the_box_of_a_sphere_lets_its_hits_through((ray, center, radius) in ball()) {
        let line = sight::line::<f32>(&[ray]);
        let middle = center.as_vec3();
        let found = sphere::meet(&line, Vector::splat(middle.to_array()), radius * radius, 0.0);
        let bounds = [
            (middle - Vec3::splat(radius)).map(f32::next_down),
            (middle + Vec3::splat(radius)).map(f32::next_up),
        ];
        let (t, hit) = found.nearest(0.0);
        if hit {
            let enter = enters(&ray, bounds)?;
            prop_assert!(enter <= t, "hit at {t}, and the box is entered at {enter}");
        }
    }

    /// What is hit in truth is let through too, whatever the primitive's own test finds.
    #[test]
    fn the_box_of_what_is_hit_in_truth_lets_the_ray_through((ray, corners) in flat()) {
        let corners = super::singles(&corners);
        let triangle = [corners[0], corners[1], corners[2]];
        for (shape, found) in [
            (&triangle[..], certified::triangle(&ray.judged(), triangle)),
            (&corners[..], certified::polygon(&ray.judged(), &corners)),
        ] {
            if found.t.is_some_and(|t| t.low > 0.0) {
                let corners: Vec<DVec3> = shape.iter().map(|corner| corner.as_dvec3()).collect();
                enters(&ray, bounds_of(&corners))?;
            }
        }
    }

    /// A ray that is in a box somewhere before its end is let in, and one that is let in is in the box grown by the padding and
    /// what the planes' own rounding adds, 24u of the coordinates in all: the test lets through no more than it has to.
    #[test]
    fn boxes_are_entered_by_rays_that_are_in_them_and_by_few_others(
        low in point(),
        size in prop_oneof![vector(positive(-20.0..0.0)), vector(prop_oneof![Just(0.0), Just(0.5)])],
        at in vector(prop_oneof![0.0..1.0, Just(0.0), Just(1.0), -0.5..1.5]),
        off in log_uniform(-28.0..-16.0),
        end in prop_oneof![Just(f32::INFINITY), 0.0..4.0_f32],
        ray in point().prop_flat_map(|from| aimed(from, DVec3::ZERO)),
    ) {
        let (low, high) = (rounded(low).as_vec3(), rounded(low + size).as_vec3());
        // At the box, its planes, edges and corners, and a little beside them.
        let target = low.as_dvec3() + at * (high - low).as_dvec3() + off * DVec3::new(1.0, -0.7, 0.3);
        let direction = target - ray.o();
        prop_assume!(direction.as_vec3() != Vec3::ZERO && low.cmple(high).all());
        for ray in [Sight::new(ray.o(), direction), Sight::new(target - ray.d(), ray.d())] {
            let extent = low.abs().max(high.abs()).max_element();
            let slabs = sight::slabs::<f32>(&[ray], extent);
            let [near, far] = sight::planes(&[ray], &[[low.to_array(), high.to_array()]]);
            let (_, is_entered) = bounds::enter(&slabs, near, far, 0.0, end);
            let meets = |low: Vec3, high: Vec3| certified::axis_box(&ray.judged(), low, high, f64::from(end));
            let farthest = Vec3::from(ray.origin).abs().max_element();
            let grown = Vec3::splat(1.5 * bounds::PADDING * (extent + farthest));
            if meets(low, high) != BoxMeeting::Missed {
                prop_assert!(is_entered, "in the box, and not let in");
            } else if is_entered {
                prop_assert!(meets(low - grown, high + grown) != BoxMeeting::Missed, "let in far from the box");
            }
        }
    }
}
