//! A bounding volume hierarchy of eight children a node, built for the least expected cost of a ray.
//!
//! [`binary`] parts the primitives top down by the binned surface area heuristic ([`split`], [`bins`]) and decides bottom up which
//! parts become nodes and which leaves ([`choice`]); [`collapse`] writes these out.
//!
//! The tree is the same to the bit for any number of threads: what runs in parallel works on parts that depend on the
//! primitives alone, and their results are put together in order.

mod binary;
mod bins;
mod bounds;
mod choice;
mod collapse;
mod cost;
mod extent;
mod group;
mod node;
mod reference;
mod split;
#[cfg(test)]
mod tests;

pub(crate) use bounds::Bounds;
pub(crate) use cost::Costs;
pub(crate) use node::{Child, Leaf, Node, Unpacked, WIDTH};

use rayon::prelude::*;
use reference::Reference;

/// Which test a primitive takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Sphere,
    Triangle,
    Polygon,
}

impl Kind {
    pub(crate) const COUNT: usize = 3;
}

/// What the builder knows of a primitive; its place in the caller's list is its index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Item {
    /// Without NaN.
    pub bounds: Bounds,
    pub kind: Kind,
    /// Share of [`Costs::room`] that it takes up: 1, or more for a polygon of many corners. 0 counts as 1.
    pub weight: u16,
}

/// Most wide nodes on the way from the root to a leaf, the root included. A traversal that puts the children of a node on
/// a stack and goes on with one of them has at most `DEPTH_LIMIT · (WIDTH − 1) + 1` waiting.
pub(crate) const DEPTH_LIMIT: u32 = 48;

/// Nodes in depth-first order, each before those below it; leaves of each kind and primitives in the order of the same walk.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    /// By [`Kind`].
    pub leaves: [Vec<Leaf>; Kind::COUNT],
    /// The caller's indices, in the order of the leaves.
    pub order: Vec<u32>,
    /// The first node, or [`Child::EMPTY`] where there is no item.
    pub root: Child,
    /// Of all items.
    pub bounds: Bounds,
    /// Wide nodes on the longest way from the root to a leaf, the root included; at most [`DEPTH_LIMIT`].
    pub depth: u32,
    /// What a random ray that meets the root's box is expected to cost; 0 for a tree of nothing.
    pub cost: f64,
}

/// Builds on the threads of the current pool.
///
/// # Panics
///
/// For more than [`Child::LIMIT`] items.
pub(crate) fn build(items: impl IndexedParallelIterator<Item = Item>, costs: &Costs) -> Tree {
    let count = items.len();
    assert!(count <= Child::LIMIT as usize, "{count} items are more than a tree can number");
    let references = items.enumerate().map(|(index, item)| Reference::new(word(index), item)).collect();
    collapse::collapse(binary::build(references, costs), costs)
}

/// An index or count of items; there are fewer than 2³⁰ of them.
#[expect(clippy::cast_possible_truncation, reason = "`build` checks it")]
fn word(count: usize) -> u32 {
    count as u32
}
