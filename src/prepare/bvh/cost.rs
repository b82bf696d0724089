//! What a tree costs: the surface area heuristic of Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for
//! Ray Tracing", 1987. A ray that meets the root meets a box within with the chance that is the ratio of their areas.

use super::{Bounds, Kind};
use glam::Vec3A;
use std::ops::Range;

/// What the steps of a traversal cost, in any unit. Arrays go by [`Kind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Costs {
    /// Of visiting a wide node.
    pub node: f32,
    /// Of a wide node's being there, for all rays that meet the root, over the number of items.
    pub node_memory: f32,
    /// Of testing one block of primitives.
    pub block: [f32; Kind::COUNT],
    /// Weight that a block has room for.
    pub room: [f32; Kind::COUNT],
    /// Most primitives in a leaf; at least 1.
    pub largest_leaf: u32,
    /// Of which kinds a group that may be a leaf is one, without asking what its parts would cost.
    pub stays_whole: [bool; Kind::COUNT],
}

impl Costs {
    /// Of testing primitives of these weights, a lane a kind.
    pub(super) fn of_weights(&self, weights: Vec3A) -> f32 {
        (weights / Vec3A::from(self.room)).ceil().dot(Vec3A::from(self.block))
    }

    /// Likewise, of three groups, a lane a group; by kind, of which some have no weights.
    #[inline(always)]
    pub(super) fn of_lanes(&self, weights: &[Vec3A; Kind::COUNT], kinds: Range<usize>) -> Vec3A {
        // A sum with 2²³ rounds to the nearest integer: sooner had than a ceiling. Weights are integers, so a number of blocks is
        // above an integer by no less than 1 / room.
        const INTEGERS: f32 = (1 << 23) as f32;
        let of_kind = |kind: usize| {
            let per_block = self.room[kind].recip();
            let nearest = weights[kind] * per_block + (0.5 - 0.5 * per_block);
            ((nearest + INTEGERS) - INTEGERS) * self.block[kind]
        };
        kinds.fold(Vec3A::ZERO, |all, kind| all + of_kind(kind))
    }

    /// Of testing a leaf of this weight.
    fn of_leaf(&self, kind: Kind, weight: u32) -> f64 {
        let blocks = (f64::from(weight) / f64::from(self.room[kind as usize])).ceil();
        blocks * f64::from(self.block[kind as usize])
    }

    /// Of a child, to a ray that meets its parent's box, times that box's area.
    pub(super) fn of_child(&self, bounds: Bounds, leaf: Option<(Kind, u32)>) -> f64 {
        bounds.half_area() * leaf.map_or(f64::from(self.node), |(kind, weight)| self.of_leaf(kind, weight))
    }
}

/// What a random ray that meets the root's box is expected to cost, from the sum of [`Costs::of_child`].
pub(super) fn of_tree(root: Bounds, children: f64, costs: &Costs) -> f64 {
    let area = root.half_area();
    // Boxes without area are met by no random ray; the root itself is always looked at.
    f64::from(costs.node) + if area > 0.0 { children / area } else { 0.0 }
}
