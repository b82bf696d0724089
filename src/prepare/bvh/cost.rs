//! What a tree costs: the surface area heuristic of Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for
//! Ray Tracing", 1987. A ray that meets the root meets a box within with the chance that is the ratio of their areas.

use super::{Bounds, Kind, Leaf, Node, Tree, Unpacked, WIDTH};
use glam::Vec3A;

/// What the steps of a traversal cost, in any unit. Arrays go by [`Kind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Costs {
    /// Of visiting a wide node.
    pub node: f32,
    /// Of testing one block of primitives.
    pub block: [f32; Kind::COUNT],
    /// Weight that a block has room for.
    pub room: [f32; Kind::COUNT],
    /// Most primitives in a leaf; at least 1.
    pub largest_leaf: u32,
}

impl Costs {
    /// Of testing primitives of these weights, a lane a kind.
    pub(super) fn of_weights(&self, weights: Vec3A) -> f32 {
        (weights / Vec3A::from(self.room)).ceil().dot(Vec3A::from(self.block))
    }

    fn of_leaf(&self, leaf: &Leaf) -> f64 {
        let blocks = (f64::from(leaf.weight) / f64::from(self.room[leaf.kind as usize])).ceil();
        blocks * f64::from(self.block[leaf.kind as usize])
    }
}

/// What a random ray that meets the root's box is expected to cost; 0 for a tree of nothing.
pub(crate) fn sah_cost(tree: &Tree, costs: &Costs) -> f64 {
    let bounds_of = |node: &Node| (0..WIDTH).fold(Bounds::EMPTY, |all, slot| all.union(node.bounds(slot)));
    let Some(root) = tree.nodes.first() else { return 0.0 };
    let of_slot = |node: &Node, slot: usize| {
        let cost = match node.children[slot].unpack() {
            Unpacked::Empty => return 0.0,
            Unpacked::Inner(_) => f64::from(costs.node),
            Unpacked::Leaf(_, leaf) => costs.of_leaf(&tree.leaves[leaf as usize]),
        };
        node.bounds(slot).half_area() * cost
    };
    let below: f64 = tree.nodes.iter().flat_map(|node| (0..WIDTH).map(move |slot| of_slot(node, slot))).sum();
    let area = bounds_of(root).half_area();
    // Boxes without area are met by no random ray; the root itself is always looked at.
    f64::from(costs.node) + if area > 0.0 { below / area } else { 0.0 }
}
