//! What the halves of the binary tree become in a tree of wide nodes for the least cost: Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017.
//!
//! A group becomes one child of a node: a leaf if it may, or a node of its own; or it spreads over several children, so
//! many for its left half and so many for its right. The cheapest way follows from those of its halves:
//!
//! - over i children: Dᵢ = min over 0 < k < i of C_k(left) + C_(i−k)(right)
//! - as one child: C₁ = min(area · cost of the leaf, area · cost of visiting a node + that of its memory + D₈)
//! - as up to i children: Cᵢ = min(Dᵢ, Cᵢ₋₁)

use super::WIDTH;

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
    /// One child, a leaf, and nothing else.
    pub(super) const LEAF: Self = Self(1 << Self::LEAF_BIT);
    const LEAF_BIT: u32 = 28;

    /// Of 2 to 8 children, how many go to the left half; 0 if one child fewer is as cheap.
    pub(super) fn left_of(self, children: usize) -> usize {
        (self.0 >> (4 * (children - 2)) & 15) as usize
    }

    #[expect(clippy::cast_possible_truncation, reason = "at most 8")]
    fn set_left_of(&mut self, children: usize, left: u64) {
        self.0 |= (left as u32) << (4 * (children - 2));
    }

    fn set_leaf(&mut self) {
        self.0 |= 1 << Self::LEAF_BIT;
    }

    /// Whether one child is a leaf and not a node.
    pub(super) fn is_leaf(self) -> bool {
        self.0 >> Self::LEAF_BIT != 0
    }
}

/// Of two halves that do not part: it makes no difference over how many children they might spread.
pub(super) fn weigh_pair(left: f64, right: f64, as_leaf: f64, as_node: f64) -> (LeastCosts, Choices) {
    let mut choices = Choices::NONE;
    let apart = left + right;
    choices.set_left_of(WIDTH, 1);
    let mut cost = as_node + apart;
    if as_leaf <= cost {
        choices.set_leaf();
        cost = as_leaf;
    }
    let mut least = LeastCosts::of_leaf(cost);
    if apart < cost {
        choices.set_left_of(2, 1);
        least.0[1..].fill(apart);
    }
    (least, choices)
}

/// The cheapest ways for a group, from those of its halves, from what it costs as a leaf, infinity if it may not be one, and
/// from what visiting it as a node and having that costs.
pub(super) fn weigh(
    left: &LeastCosts,
    right: &LeastCosts,
    as_leaf: f64,
    as_node: f64,
) -> (LeastCosts, Choices) {
    let mut choices = Choices::NONE;
    let (spreads, to_left) = cheapest_over_each(left, right);
    choices.set_left_of(WIDTH, to_left[WIDTH - 1]);
    let mut cost = as_node + spreads[WIDTH - 1];
    if as_leaf <= cost {
        choices.set_leaf();
        cost = as_leaf;
    }
    let mut least = LeastCosts::of_leaf(cost);
    for children in 2..WIDTH {
        let spread = spreads[children - 1];
        // Without a branch, which nothing could foresee.
        let is_less = spread < cost;
        choices.set_left_of(children, u64::from(is_less) * to_left[children - 1]);
        cost = if is_less { spread } else { cost };
        least.0[children - 1] = cost;
    }
    (least, choices)
}

/// The least costs of a group as 1, 2, … 8 children, and how many of them are its left half. As one child it does not spread:
/// that costs infinity.
fn cheapest_over_each(left: &LeastCosts, right: &LeastCosts) -> ([f64; WIDTH], [u64; WIDTH]) {
    // What no children cost the right half, infinity, then what 1, 2, … do.
    let mut padded = [f64::INFINITY; 2 * WIDTH];
    padded[WIDTH..2 * WIDTH - 1].copy_from_slice(&right.0);
    let (mut costs, mut to_left) = ([f64::INFINITY; WIDTH], [1; WIDTH]);
    for (count, &of_left) in (1..).zip(&left.0) {
        let of_right = &padded[WIDTH - count..];
        for lane in 0..WIDTH {
            let cost = of_left + of_right[lane];
            let is_less = cost < costs[lane];
            costs[lane] = if is_less { cost } else { costs[lane] };
            to_left[lane] = if is_less { count as u64 } else { to_left[lane] };
        }
    }
    (costs, to_left)
}
