//! Streams with more rays than the other tests have: lists of every length, full parts and several, windows and what is sorted
//! before.

use super::super::{RUN, batch};
use super::Random;
use super::rays::{assert_same_as_all, end, shuffled};
use super::scenes::mixed;
use crate::prepare::Prepared;
use crate::prepare::bvh::{Child, Node};
use crate::traverse::regroup::WINDOW;
use crate::traverse::stream::CAPACITY;

/// Several parts of a class, and one that is not full.
#[test]
fn many_rays_find_what_a_loop_finds() {
    for (seed, size) in [(1, 30), (2, 120), (3, 400)] {
        let random = &mut Random::new(seed);
        let scene = mixed(random, size, 0.3);
        let prepared = Prepared::new(&scene).unwrap();
        let mut rays = shuffled(random, 3 * CAPACITY + 7);
        // All of one class, so that parts are full.
        for ray in &mut rays {
            ray.sight.direction = ray.sight.direction.map(f32::abs);
        }
        end(random, &mut rays);
        let (in_packets, hits) = assert_same_as_all(&prepared, &rays, false);
        assert_eq!(in_packets, 0);
        assert!(hits > 100, "{hits}");
    }
}

#[test]
fn more_rays_than_a_window_in_no_order_find_what_a_loop_finds() {
    let random = &mut Random::new(9);
    let scene = mixed(random, 8, 0.0);
    let prepared = Prepared::new(&scene).unwrap();
    let rays = shuffled(random, WINDOW + 3000);
    let (_, hits) = assert_same_as_all(&prepared, &rays, false);
    assert!(hits > 1000, "{hits}");
}

/// Shares that threads take of rays in an order, of whole runs.
#[test]
fn threads_get_shares_alike_of_rays_in_an_order() {
    for count in [1, 100 * RUN, WINDOW - 1, WINDOW, 3 * WINDOW + 1, 40 * WINDOW] {
        for threads in [1, 2, 3, 16] {
            let share = batch(count, threads);
            assert!(share <= WINDOW && share.is_multiple_of(RUN), "{share}");
            let shares = count.div_ceil(share);
            if threads == 1 {
                assert_eq!(shares, count.div_ceil(WINDOW), "{count} rays");
            } else if count >= threads * WINDOW {
                assert!(shares >= 4 * threads, "{shares} shares of {count} rays for {threads} threads");
                // The last is smaller by less than a run for each of the others.
                assert!(
                    count - (shares - 1) * share + shares * RUN > share,
                    "{count} rays in shares of {share}"
                );
            }
        }
    }
}

/// Of each octant the order holds all children, and puts those that are farther back along it later.
#[test]
fn a_node_knows_in_which_order_rays_meet_its_children() {
    let random = &mut Random::new(5);
    let scene = mixed(random, 300, 0.0);
    let prepared = Prepared::new(&scene).unwrap();
    for node in &prepared.hierarchy.nodes {
        for octant in 0..8 {
            let order = node.orders[octant];
            let slots: Vec<usize> = (0..order.count()).map(|rank| order.slot(rank)).collect();
            let mut sorted = slots.clone();
            sorted.sort_unstable();
            let used = node.children.iter().filter(|&&child| child != Child::EMPTY).count();
            assert_eq!(sorted, (0..used).collect::<Vec<_>>());
            assert!(slots.is_sorted_by(|&one, &next| along(node, one, octant) <= along(node, next, octant)));
        }
    }
}

/// Where the middle of a child's box is along an octant's diagonal.
fn along(node: &Node, slot: usize, octant: usize) -> f32 {
    let sides = [0, 1, 2].map(|axis| {
        let middle = 0.5 * node.low[axis][slot] + 0.5 * node.high[axis][slot];
        if octant >> axis & 1 == 1 { -middle } else { middle }
    });
    sides[0] + sides[1] + sides[2]
}
