//! From the binary tree to nodes of eight children for the least cost: Ylitie, Karras and Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", 2017, section 3.2.
//!
//! A group becomes one child of a node: a leaf if it may, or a node; or it spreads over several children, so many for its
//! left half and so many for its right. The cheapest way follows from those of its halves:
//!
//! - node: C₁ = area · node cost + D₈
//! - leaf: C₁ = area · leaf cost
//! - i children: Dᵢ = min over 0 < k < i of C_k(left) + C_(i−k)(right)
//! - up to i children: Cᵢ = min(Dᵢ, Cᵢ₋₁)

use super::binary::{BinaryTree, Fork};
use super::{Bounds, Child, Leaf, Node, Tree, WIDTH, word};

/// What a group costs as up to 1, 2, … 7 children of a node.
pub(super) struct LeastCosts([f64; WIDTH - 1]);

impl LeastCosts {
    /// A group that does not part.
    pub(super) fn of_leaf(cost: f64) -> Self {
        Self([cost; WIDTH - 1])
    }
}

/// The cheapest ways for a group, in 4 bits each.
#[derive(Clone, Copy)]
pub(super) struct Choices(u32);

impl Choices {
    pub(super) const NONE: Self = Self(0);

    /// Of 2 to 8 children, how many go to the left half; 0 if one child fewer is as cheap.
    fn left_of(self, children: usize) -> usize {
        (self.0 >> (4 * (children - 2)) & 15) as usize
    }

    fn set_left_of(&mut self, children: usize, left: u32) {
        self.0 |= left << (4 * (children - 2));
    }

    fn set_leaf(&mut self) {
        self.0 |= 1 << 28;
    }

    /// Whether one child is a leaf and not a node.
    fn is_leaf(self) -> bool {
        self.0 >> 28 != 0
    }
}

/// The cheapest ways for a group, from those of its halves, what it costs as a leaf if it may be one, and what visiting it
/// costs as a node.
pub(super) fn weigh(
    LeastCosts(left): &LeastCosts,
    LeastCosts(right): &LeastCosts,
    as_leaf: Option<f64>,
    as_node: f64,
) -> (LeastCosts, Choices) {
    let mut choices = Choices::NONE;
    let mut spread_costs = [(f64::INFINITY, 0); WIDTH + 1];
    for (children, cheapest) in spread_costs.iter_mut().enumerate().skip(2) {
        for (to_left, k) in (1..children).zip(1..) {
            let cost = left[to_left - 1] + right[children - to_left - 1];
            if cost < cheapest.0 {
                *cheapest = (cost, k);
            }
        }
    }
    let (all, to_left) = spread_costs[WIDTH];
    choices.set_left_of(WIDTH, to_left);
    let mut cost = as_node + all;
    if let Some(as_leaf) = as_leaf
        && as_leaf <= cost
    {
        choices.set_leaf();
        cost = as_leaf;
    }
    let mut costs = LeastCosts::of_leaf(cost);
    for children in 2..WIDTH {
        let (spread_cost, to_left) = spread_costs[children];
        if spread_cost < cost {
            choices.set_left_of(children, to_left);
            cost = spread_cost;
        }
        costs.0[children - 1] = cost;
    }
    (costs, choices)
}

/// A run of references and the first of its forks.
#[derive(Clone, Copy)]
struct Run {
    first: usize,
    count: usize,
    fork: usize,
}

/// The children of one node, in the order of their leaves.
#[derive(Default)]
struct Children {
    runs: [Option<Run>; WIDTH],
    count: usize,
}

pub(super) fn collapse(binary: BinaryTree) -> Tree {
    let count = binary.references.len();
    let tree = Tree { nodes: Vec::new(), leaves: Vec::new(), order: Vec::new(), root: Child::EMPTY, depth: 0 };
    let mut writer = Writer { binary: &binary, tree };
    if count > 0 {
        writer.tree.root = writer.write_node(Run { first: 0, count, fork: 0 }, 1);
    }
    let mut tree = writer.tree;
    tree.order = binary.references.iter().map(|reference| reference.index).collect();
    tree
}

struct Writer<'a> {
    binary: &'a BinaryTree,
    tree: Tree,
}

impl Writer<'_> {
    /// Appends the node of a run and all below it.
    fn write_node(&mut self, run: Run, depth: u32) -> Child {
        let index = self.tree.nodes.len();
        self.tree.nodes.push(Node::EMPTY);
        self.tree.depth = self.tree.depth.max(depth);
        let mut children = Children::default();
        self.spread(run, WIDTH, &mut children);
        for (slot, run) in children.runs.into_iter().flatten().enumerate() {
            let child = if self.fork(run).is_none_or(|fork| fork.choices.is_leaf()) {
                self.write_leaf(run)
            } else {
                self.write_node(run, depth + 1)
            };
            let bounds = self.bounds(run);
            self.tree.nodes[index].set(slot, bounds, child);
        }
        Child::inner(word(index))
    }

    fn write_leaf(&mut self, run: Run) -> Child {
        let references = &self.binary.references[run.first..run.first + run.count];
        let kind = references[0].kind;
        let weight = references.iter().map(|reference| u32::from(reference.weight)).sum();
        let index = word(self.tree.leaves.len());
        self.tree.leaves.push(Leaf { kind, first: word(run.first), count: word(run.count), weight });
        Child::leaf(kind, index)
    }

    /// Spreads a run over up to so many children.
    fn spread(&self, run: Run, mut limit: usize, children: &mut Children) {
        let mut left = 0;
        if let Some(fork) = self.fork(run) {
            while limit > 1 && left == 0 {
                left = fork.choices.left_of(limit);
                limit -= usize::from(left == 0);
            }
            if left > 0 {
                let middle = fork.left as usize;
                let left_run = Run { first: run.first, count: middle, fork: run.fork + 1 };
                let right_run =
                    Run { first: run.first + middle, count: run.count - middle, fork: run.fork + middle };
                self.spread(left_run, left, children);
                self.spread(right_run, limit - left, children);
                return;
            }
        }
        children.runs[children.count] = Some(run);
        children.count += 1;
    }

    /// `None` for a single item.
    fn fork(&self, run: Run) -> Option<&Fork> {
        (run.count > 1).then(|| &self.binary.forks[run.fork])
    }

    fn bounds(&self, run: Run) -> Bounds {
        self.fork(run).map_or_else(|| self.binary.references[run.first].bounds, |fork| fork.bounds)
    }
}
