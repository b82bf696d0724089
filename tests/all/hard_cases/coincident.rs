//! Case 26: surfaces that lie in one place.

use super::case::{Shape, scene};
use super::run::{ENGINES, Engines};
use super::solids::spread;
use Shape::{Polygon, Sphere, Triangle};
use std::ops::Range;
use wavelane::rays::RaySet;
use wavelane::trace::Query;

/// The same surface twice. Ids count the first, then what else is in the scene, then the second.
fn pairs() -> [(&'static str, [Vec<Shape>; 2]); 4] {
    let bent = [[-1.0, -0.9, 0.1], [1.1, -1.0, 0.3], [1.0, 1.2, 0.5], [-1.1, 1.3, 0.3]];
    // Sixteenths, which one plane holds to the bit.
    let flat =
        [[-1.0, -0.875], [1.125, -1.0], [1.0, 1.25], [-1.125, 1.25]].map(|[x, y]| [x, y, 0.25 * x + 0.5]);
    let polygon = vec![Polygon(flat.to_vec())];
    let halves = |[a, b, c, d]: [[f32; 3]; 4]| vec![Triangle([a, b, c]), Triangle([a, c, d])];
    let ball = vec![Sphere([0.1, 0.2, 0.3], 1.0)];
    let [a, b, c, d] = flat;
    [
        ("spheres", [ball.clone(), ball]),
        ("triangles", [halves(bent), halves(bent)]),
        ("polygons", [polygon.clone(), polygon.clone()]),
        // Cut the other way, and of the other sense.
        ("a polygon and triangles", [polygon, halves([d, c, b, a])]),
    ]
}

/// From three sides at 24 × 24 points each.
fn rays() -> RaySet {
    let origins = [[0.3, -0.4, 7.0], [3.0, 4.0, 5.0], [-1.0, 0.2, -9.0_f32]];
    let points = (0..24_u8).flat_map(|i| (0..24_u8).map(move |j| [i, j].map(|k| f32::from(k) / 13.0 - 0.9)));
    let rows = points.flat_map(|[x, y]| {
        origins.map(|[ox, oy, oz]| [ox, oy, oz, 0.0, x - ox, y - oy, 0.4 - oz, f32::INFINITY])
    });
    RaySet { rows: rows.collect(), ..RaySet::default() }
}

#[test]
fn case_26_coincident_surfaces() {
    let rays = rays();
    for (name, [first, second]) in pairs() {
        let firsts = first.len() as u32;
        // Other primitives change the tree. They are to both sides, beyond all rays.
        for others in [0, 3, 40, 700_u32] {
            let beside = |index: u32| {
                let [x, y, z] = [1, 2, 3].map(|axis| (10.0 * spread(index * 3 + axis)) as f32);
                let x = if index.is_multiple_of(2) { 15.0 + x } else { -15.0 - x };
                Sphere([x, y - 5.0, z - 5.0], 0.05)
            };
            let all = first.iter().cloned().chain((0..others).map(beside)).chain(second.iter().cloned());
            let scene = scene(&all.collect::<Vec<_>>());
            for threads in [1, 2, 5] {
                let ready = Engines::new(&scene, threads);
                for engine in ENGINES {
                    let found = ready.hits(&rays, engine, Query::Closest);
                    let count = |ids: Range<u32>| found.id.iter().filter(|id| ids.contains(id)).count();
                    let (seen, wrong) = (count(0..firsts), count(firsts + others..u32::MAX));
                    assert!(
                        wrong == 0 && seen > 500,
                        "case 26, coincident surfaces, {name} among {others} others, {engine:?} on {threads} threads: \
                         {wrong} rays see the larger id, {seen} the smaller; wanted 0 and more than 500"
                    );
                }
            }
        }
    }
}
