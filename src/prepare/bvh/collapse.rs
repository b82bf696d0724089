//! From the binary tree to nodes of eight children, as its choices say.

use super::binary::{BinaryTree, Fork};
use super::{Bounds, Child, Leaf, Node, Tree, WIDTH, word};

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

pub(super) fn collapse(binary: &BinaryTree) -> Tree {
    let order: Vec<u32> = binary.references.iter().map(|reference| reference.index).collect();
    let all = Run { first: 0, count: order.len(), fork: 0 };
    let tree = Tree { nodes: Vec::new(), leaves: Vec::new(), order, root: Child::EMPTY, depth: 0 };
    let mut writer = Writer { binary, tree };
    if all.count > 0 {
        writer.tree.root = writer.write_node(all, 1);
    }
    writer.tree
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
        self.tree.nodes[index].set_orders();
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
        self.fork(run).map_or_else(|| self.binary.references[run.first].bounds, |fork| fork.bounds)
    }
}
