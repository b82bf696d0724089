//! The judge, judged: by what changes nothing, by closed forms, and by asking one question in two ways.

mod closed_forms;
mod filter;
mod scenes;
mod symmetry;
mod two_ways;

use super::Line;
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// A number of f32: of any magnitude between 2⁻²⁰ and 2, any power as likely, or on a grid of quarters, where what is exactly on an
/// edge is common.
fn coordinate() -> impl Strategy<Value = f32> + Clone {
    let any = (-20.0..1.0_f32, any::<bool>());
    prop_oneof![
        1 => any.prop_map(|(power, negative)| if negative { -power.exp2() } else { power.exp2() }),
        2 => (-8..=8_i8).prop_map(|step| f32::from(step) / 4.0),
    ]
}

fn point() -> impl Strategy<Value = Vec3> + Clone {
    // Of one kind: a grid point beside others that are not is on no edge.
    let grid = || (-8..=8_i8).prop_map(|step| f32::from(step) / 4.0);
    prop_oneof![
        1 => [coordinate(), coordinate(), coordinate()],
        2 => [grid(), grid(), grid()],
    ]
    .prop_map(Vec3::from)
}

/// A line from one point towards another, or to between two of some corners, as exactly as f32 has it.
fn towards(corners: Vec<Vec3>) -> impl Strategy<Value = Line> + Clone {
    let share = prop_oneof![2 => (0..=4_u8).prop_map(|step| f32::from(step) / 4.0), 1 => -0.2..1.2_f32];
    let at = any::<prop::sample::Index>();
    (point(), at.clone(), at, share).prop_filter_map(
        "the line needs a direction",
        move |(origin, a, b, share)| {
            let [a, b] = [a, b].map(|at| corners[at.index(corners.len())]);
            let direction = a.lerp(b, share) - origin;
            (direction != Vec3::ZERO).then(|| line(origin, direction))
        },
    )
}

fn line(origin: Vec3, direction: Vec3) -> Line {
    Line::new(origin.to_array(), direction.to_array())
}

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a) != DVec3::ZERO
}

/// A triangle with some area, and a line that may well meet it.
fn at_triangle() -> impl Strategy<Value = (Line, [Vec3; 3])> {
    let corners =
        [point(), point(), point()].prop_filter("a triangle needs an area", |corners| has_area(*corners));
    corners.prop_flat_map(|corners| towards(corners.to_vec()).prop_map(move |line| (line, corners)))
}

/// A polygon of up to seven corners in a plane of the grid, which may cross itself, and a line that may well meet it.
fn at_polygon() -> impl Strategy<Value = (Line, Vec<Vec3>)> {
    let step = || (-4..=4_i8).prop_map(|step| f32::from(step) / 4.0);
    let shape = (point(), point(), point(), prop::collection::vec([step(), step()], 3..8));
    let corners = shape.prop_map(|(at, x, y, places)| {
        places.into_iter().map(|[u, v]| at + u * x + v * y).collect::<Vec<_>>()
    });
    corners.prop_flat_map(|corners| towards(corners.clone()).prop_map(move |line| (line, corners.clone())))
}

/// A sphere, and a line at a share of its radius from its centre, often at exactly the radius.
fn at_sphere() -> impl Strategy<Value = (Line, Vec3, f32)> {
    let radius = prop_oneof![1 => (1..=8_u8).prop_map(|step| f32::from(step) / 4.0), 1 => (-20.0..1.0_f32).prop_map(f32::exp2)];
    let share =
        prop_oneof![1 => Just(0.0), 2 => Just(1.0_f32), 1 => Just(1.0_f32.next_up()), 1 => 0.0..1.5_f32];
    let axes = prop::sample::select(vec![[0, 1], [1, 2], [2, 0], [1, 0]]);
    let free = point().prop_map(Some);
    (point(), radius, share, axes, prop_oneof![1 => Just(None), 1 => free], point()).prop_filter_map(
        "the line needs a direction",
        |(center, radius, share, [aside, along], towards, from)| {
            let mut origin = from;
            let mut direction = Vec3::ZERO;
            match towards {
                None => {
                    origin = center;
                    origin[aside] += share * radius;
                    origin[along] -= 2.0;
                    direction[along] = 1.0;
                }
                Some(towards) => direction = center + share * radius * towards.normalize_or_zero() - origin,
            }
            (direction != Vec3::ZERO).then(|| (line(origin, direction), center, radius))
        },
    )
}
