//! From the binary tree to nodes of eight children, as its choices say.

use super::binary::{BinaryTree, Fork};
use super::cost::of_tree;
use super::reference::Reference;
use super::{Bounds, Child, Costs, Kind, Leaf, Node, Tree, WIDTH, word};
use rayon::prelude::*;

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

pub(super) fn collapse(binary: BinaryTree, costs: &Costs) -> Tree {
    let count = binary.references.len();
    let mut tree = Tree {
        nodes: Vec::with_capacity(count / 8),
        leaves: Default::default(),
        order: Vec::new(),
        root: Child::EMPTY,
        bounds: Bounds::EMPTY,
        depth: 0,
        cost: 0.0,
    };
    if count > 0 {
        let all = Run { first: 0, count, fork: 0 };
        let mut writer = Writer { binary: &binary, costs, tree, children_cost: 0.0 };
        let root = writer.write_node(all, 1);
        let (bounds, children_cost) = (writer.bounds(all), writer.children_cost);
        tree = writer.tree;
        (tree.root, tree.bounds, tree.cost) = (root, bounds, of_tree(bounds, children_cost, costs));
    }
    let BinaryTree { references, forks } = binary;
    drop(forks);
    tree.order = references.par_iter().map(Reference::index).collect();
    tree
}

struct Writer<'a> {
    binary: &'a BinaryTree,
    costs: &'a Costs,
    tree: Tree,
    /// Sum of [`Costs::of_child`].
    children_cost: f64,
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
            let bounds = self.bounds(run);
            let child = if self.fork(run).is_none_or(|fork| fork.choices.is_leaf()) {
                let (child, kind, weight) = self.write_leaf(run);
                self.children_cost += self.costs.of_child(bounds, Some((kind, weight)));
                child
            } else {
                self.children_cost += self.costs.of_child(bounds, None);
                self.write_node(run, depth + 1)
            };
            self.tree.nodes[index].set(slot, bounds, child);
        }
        self.tree.nodes[index].set_orders();
        Child::inner(word(index))
    }

    /// Returns the child, its kind and its weight.
    fn write_leaf(&mut self, run: Run) -> (Child, Kind, u32) {
        let references = &self.binary.references[run.first..run.first + run.count];
        let kind = references[0].kind();
        let weight = references.iter().map(|reference| u32::from(reference.weight())).sum();
        let leaves = &mut self.tree.leaves[kind as usize];
        leaves.push(Leaf { first: word(run.first), count: word(run.count) });
        (Child::leaf(kind, word(leaves.len() - 1)), kind, weight)
    }

    /// Spreads a run over up to `limit` children.
    fn spread(&self, run: Run, limit: usize, children: &mut Children) {
        let split = self.fork(run).and_then(|fork| {
            let mut ways = (2..=limit).rev().map(|count| (count, fork.choices.left_of(count)));
            ways.find(|&(_, left)| left > 0).map(|way| (way, fork.left as usize))
        });
        let Some(((count, left), middle)) = split else {
            children.runs[children.count] = Some(run);
            children.count += 1;
            return;
        };
        let left_run = Run { first: run.first, count: middle, fork: run.fork + 1 };
        let right_run = Run { first: run.first + middle, count: run.count - middle, fork: run.fork + middle };
        self.spread(left_run, left, children);
        self.spread(right_run, count - left, children);
    }

    /// `None` for a single item.
    fn fork(&self, run: Run) -> Option<&Fork> {
        (run.count > 1).then(|| &self.binary.forks[run.fork])
    }

    fn bounds(&self, run: Run) -> Bounds {
        self.fork(run).map_or_else(|| self.binary.references[run.first].bounds(), |fork| fork.bounds)
    }
}
