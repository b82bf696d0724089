//! The binary tree: parted top down, weighed bottom up.

use super::choice::{Choices, LeastCosts, weigh, weigh_pair};
use super::group::{Group, Spread};
use super::reference::Reference;
use super::split::{Halves, halve, part};
use super::{Bounds, Costs, DEPTH_LIMIT, word};
use rayon::prelude::*;

/// Above so many items the two halves are built in parallel.
const PARALLEL: usize = 1024;

/// A place where a group of items parts in two. A group of n items parts in at most n − 1 places, itself and those within
/// its halves, so the places of every group are known before it is built: its own first, then those of the left half, then
/// those of the right.
#[derive(Clone, Copy)]
pub(super) struct Fork {
    pub(super) bounds: Bounds,
    /// Items that go left.
    pub(super) left: u32,
    pub(super) choices: Choices,
}

impl Fork {
    const UNUSED: Self = Self { bounds: Bounds::EMPTY, left: 0, choices: Choices::NONE };
}

pub(super) struct BinaryTree {
    /// In the order of the leaves.
    pub(super) references: Vec<Reference>,
    /// One fewer.
    pub(super) forks: Vec<Fork>,
}

pub(super) fn build(mut references: Vec<Reference>, costs: &Costs) -> BinaryTree {
    // On all threads, since memory that is touched for the first time has to be fetched from the system.
    let places = 0..references.len().saturating_sub(1);
    let mut forks: Vec<Fork> = places.into_par_iter().map(|_| Fork::UNUSED).collect();
    if !references.is_empty() {
        let spread = Spread::of(&references);
        let prices = Prices::new(&spread, references.len(), costs);
        grow(&mut references, &mut forks, &spread, 0, &prices);
    }
    BinaryTree { references, forks }
}

/// What a tree's parts cost.
struct Prices<'a> {
    steps: &'a Costs,
    /// Of a node's being there: an area times a cost.
    node_memory: f64,
}

impl<'a> Prices<'a> {
    /// Of so many items.
    fn new(spread: &Spread, count: usize, costs: &'a Costs) -> Self {
        let node_memory = f64::from(costs.node_memory) * area_of(spread.group.extent.bounds()) / count as f64;
        Self { steps: costs, node_memory }
    }
}

/// Parts a group that is not empty, down to single items or to what stays whole, and returns what it costs.
fn grow(
    references: &mut [Reference],
    forks: &mut [Fork],
    spread: &Spread,
    depth: u32,
    prices: &Prices<'_>,
) -> LeastCosts {
    let costs = prices.steps;
    let Some((fork, forks)) = forks.split_first_mut() else {
        return LeastCosts::of_leaf(single(&references[0], costs));
    };
    let bounds = spread.group.extent.bounds();
    let area = area_of(bounds);
    let fits = references.len() <= costs.largest_leaf.max(1) as usize && spread.group.is_of_one_kind();
    let as_leaf = if fits { area * f64::from(costs.of_weights(spread.group.weights)) } else { f64::INFINITY };
    if fits && costs.stays_whole[references[0].kind() as usize] {
        *fork = Fork { bounds, left: 1, choices: Choices::LEAF };
        return LeastCosts::of_leaf(as_leaf);
    }
    let as_node = area * f64::from(costs.node) + prices.node_memory;
    let deep = is_deep(depth, references.len());
    if let ([one, other], false) = (&*references, deep) {
        let (least_costs, choices) = weigh_pair(single(one, costs), single(other, costs), as_leaf, as_node);
        *fork = Fork { bounds, left: 1, choices };
        return least_costs;
    }
    let halves = if deep { halve(references, spread) } else { part(references, spread, costs) };
    let Halves { middle, .. } = halves;
    debug_assert!((1..references.len()).contains(&middle));
    let parallel = references.len() >= PARALLEL;
    let (left, right) = references.split_at_mut(middle);
    let (left_forks, right_forks) = forks.split_at_mut(middle - 1);
    let mut grow_left = || grow(left, left_forks, &halves.left, depth + 1, prices);
    let mut grow_right = || grow(right, right_forks, &halves.right, depth + 1, prices);
    let (left_costs, right_costs) =
        if parallel { rayon::join(grow_left, grow_right) } else { (grow_left(), grow_right()) };
    let (least_costs, choices) = weigh(&left_costs, &right_costs, as_leaf, as_node);
    *fork = Fork { bounds, left: word(middle), choices };
    least_costs
}

/// More than 0, so that nodes and leaves count where boxes have no area.
fn area_of(bounds: Bounds) -> f64 {
    bounds.half_area().max(f64::MIN_POSITIVE)
}

/// What a leaf of one item costs.
fn single(item: &Reference, costs: &Costs) -> f64 {
    area_of(item.bounds()) * f64::from(costs.of_weights(Group::of(item).weights))
}

/// Whether the forks below `depth` others must halve from here on to stay within the limit: a cut may leave all items but
/// one together, and halves of n items need ⌈log₂ n⌉ more forks.
fn is_deep(depth: u32, count: usize) -> bool {
    let left_over = count - 1;
    depth + 1 + left_over.next_power_of_two().ilog2() > DEPTH_LIMIT
}

#[cfg(test)]
mod tests {
    use super::super::collapse::collapse;
    use super::super::{Item, Kind};
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_tree_costs_what_the_choices_promise() {
        let costs = Costs {
            node: 1.5,
            node_memory: 3.0,
            block: [1.0, 2.0, 4.0],
            room: [4.0, 4.0, 2.0],
            largest_leaf: 6,
            stays_whole: [false, true, false],
        };
        let mixed = [Kind::Sphere, Kind::Triangle, Kind::Triangle, Kind::Polygon];
        for kinds in [mixed, [Kind::Polygon; 4]] {
            check_costs(&costs, kinds);
        }
    }

    fn check_costs(costs: &Costs, kinds: [Kind; 4]) {
        let items = (0..500_u16).zip(kinds.into_iter().cycle()).map(|(index, kind)| {
            let low = Vec3::new(f32::from(index % 7), f32::from(index % 11), f32::from(index % 13));
            Item { bounds: Bounds { low, high: low + 0.3 }, kind, weight: index % 5 }
        });
        let items = (0..).zip(items).map(|(index, item)| Reference::new(index, item));
        let mut tree = build(items.collect(), costs);
        let bounds = tree.forks[0].bounds;
        let spread = Spread::of(&tree.references);
        let prices = Prices::new(&spread, tree.references.len(), costs);
        let promised = grow(&mut tree.references, &mut tree.forks, &spread, 0, &prices).as_one_child();
        let tree = collapse(tree, costs);
        let cost = tree.cost * bounds.half_area() + tree.nodes.len() as f64 * prices.node_memory;
        assert!((cost / promised - 1.0).abs() < 1e-12, "{cost}, promised {promised}");
    }
}
