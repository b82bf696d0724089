//! What the halves of the binary tree become in a tree of wide nodes for the least cost: Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017.
//!
//! A group becomes one child of a node: a leaf if it may, or a node of its own; or it spreads over several children, so
//! many for its left half and so many for its right. The cheapest way follows from those of its halves:
//!
//! - over i children: Dᵢ = min over 0 < k < i of C_k(left) + C_(i−k)(right)
//! - as one child: C₁ = min(area · cost of the leaf, area · cost of visiting a node + D₈)
//! - as up to i children: Cᵢ = min(Dᵢ, Cᵢ₋₁)

use super::{WIDTH, word};

/// What a group costs as up to 1, 2, … 7 children of a node.
pub(super) struct LeastCosts([f64; WIDTH - 1]);

impl LeastCosts {
    /// A group that does not part.
    pub(super) fn of_leaf(cost: f64) -> Self {
        Self([cost; WIDTH - 1])
    }

    #[cfg(test)]
    pub(super) fn as_one_child(&self) -> f64 {
        self.0[0]
    }
}

/// The cheapest ways for a group, in 4 bits each.
#[derive(Clone, Copy)]
pub(super) struct Choices(u32);

impl Choices {
    pub(super) const NONE: Self = Self(0);

    /// Of 2 to 8 children, how many go to the left half; 0 if one child fewer is as cheap.
    pub(super) fn left_of(self, children: usize) -> usize {
        (self.0 >> (4 * (children - 2)) & 15) as usize
    }

    fn set_left_of(&mut self, children: usize, left: usize) {
        self.0 |= word(left) << (4 * (children - 2));
    }

    fn set_leaf(&mut self) {
        self.0 |= 1 << 28;
    }

    /// Whether one child is a leaf and not a node.
    pub(super) fn is_leaf(self) -> bool {
        self.0 >> 28 != 0
    }
}

/// The cheapest ways for a group, from those of its halves, from what it costs as a leaf, infinity if it may not be one, and
/// from what visiting it as a node costs.
pub(super) fn weigh(
    left: &LeastCosts,
    right: &LeastCosts,
    as_leaf: f64,
    as_node: f64,
) -> (LeastCosts, Choices) {
    let mut choices = Choices::NONE;
    let (below, to_left) = cheapest_over(WIDTH, left, right);
    choices.set_left_of(WIDTH, to_left);
    let mut cost = as_node + below;
    if as_leaf <= cost {
        choices.set_leaf();
        cost = as_leaf;
    }
    let mut least = LeastCosts::of_leaf(cost);
    for (children, least) in (2..).zip(&mut least.0[1..]) {
        let (spread, to_left) = cheapest_over(children, left, right);
        if spread < cost {
            choices.set_left_of(children, to_left);
            cost = spread;
        }
        *least = cost;
    }
    (least, choices)
}

/// The least cost of a group as `children`, and how many of them are its left half.
fn cheapest_over(children: usize, left: &LeastCosts, right: &LeastCosts) -> (f64, usize) {
    let mut cheapest = (f64::INFINITY, 1);
    for to_left in 1..children {
        let cost = left.0[to_left - 1] + right.0[children - to_left - 1];
        if cost < cheapest.0 {
            cheapest = (cost, to_left);
        }
    }
    cheapest
}
