//! How often bounds decide, and how long a pair takes.

use super::{at_polygon, at_sphere, at_triangle};
use crate::certified::{Method, polygon, sphere, triangle};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::time::Instant;

fn drawn<T>(strategy: impl Strategy<Value = T>) -> Vec<T> {
    let mut runner = TestRunner::deterministic();
    (0..4000).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

/// How many pairs bounds decide, and the mean time of those and of the others.
fn report<T>(what: &str, cases: &[T], by: impl Fn(&T) -> Method) -> usize {
    let mut taken = [(0, 0), (0, 0)];
    for case in cases {
        let start = Instant::now();
        let method = by(case);
        let nanoseconds = start.elapsed().as_nanos();
        let (count, sum) = &mut taken[usize::from(method == Method::Fractions)];
        *count += 1;
        *sum += nanoseconds;
    }
    let [(bounds, bounds_time), (fractions, fractions_time)] = taken;
    println!(
        "{what}: {bounds} by bounds in {} ns each, {fractions} by fractions in {} ns each",
        bounds_time / bounds.max(1) as u128,
        fractions_time / fractions.max(1) as u128,
    );
    bounds
}

/// Half of the cases are aimed exactly at what takes fractions, so both ways are taken.
#[test]
fn bounds_decide_most_pairs_and_fractions_the_rest() {
    let triangles = drawn(at_triangle());
    let by_bounds = report("triangles", &triangles, |(line, corners)| triangle(line, *corners).by);
    assert!((2000..4000).contains(&by_bounds), "{by_bounds}");
    let polygons = drawn(at_polygon());
    let by_bounds = report("polygons", &polygons, |(line, corners)| polygon(line, corners).by);
    assert!((2000..4000).contains(&by_bounds), "{by_bounds}");
    let spheres = drawn(at_sphere());
    let by_bounds = report("spheres", &spheres, |(line, center, radius)| sphere(line, *center, *radius).by);
    assert!((2000..4000).contains(&by_bounds), "{by_bounds}");
}
