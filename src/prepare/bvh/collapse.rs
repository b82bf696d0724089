//! From the binary tree to nodes of eight children, as its choices say.

use super::binary::{BinaryTree, Fork};
use super::cost::of_tree;
use super::reference::Reference;
use super::{Bounds, Child, Costs, Kind, Leaf, Node, Tree, Unpacked, WIDTH, word};
use rayon::prelude::*;

/// Below nodes over so many items, children are written in two parts at once.
const PARALLEL: usize = 1 << 15;

/// A run of references and the first of its forks.
#[derive(Clone, Copy, Default)]
struct Run {
    first: usize,
    count: usize,
    fork: usize,
}

/// The children of one node, in the order of their leaves.
#[derive(Default)]
struct Children {
    runs: [Run; WIDTH],
    count: usize,
}

pub(super) fn collapse(binary: BinaryTree, costs: &Costs) -> Tree {
    let count = binary.references.len();
    let mut part = Part::with_room_for(count);
    let (mut root, mut bounds, mut cost) = (Child::EMPTY, Bounds::EMPTY, 0.0);
    if count > 0 {
        let all = Run { first: 0, count, fork: 0 };
        let writer = Writer { binary: &binary, costs };
        let written = writer.write_node(all, 1, &mut part);
        (root, bounds) = (written.child, writer.bounds(all));
        cost = of_tree(bounds, written.cost, costs);
    }
    let BinaryTree { references, forks } = binary;
    // To give memory back takes time as well.
    let (order, ()) = rayon::join(|| references.par_iter().map(Reference::index).collect(), || drop(forks));
    let Part { nodes, leaves, depth } = part;
    Tree { nodes, leaves, order, root, bounds, depth, cost }
}

/// Of a tree, what has been written: nodes and leaves of neighbours in its order.
struct Part {
    nodes: Vec<Node>,
    leaves: [Vec<Leaf>; Kind::COUNT],
    depth: u32,
}

/// A child that has been written, and the sum of [`Costs::of_child`] of all below it.
#[derive(Clone, Copy)]
struct Written {
    child: Child,
    cost: f64,
}

impl Part {
    fn with_room_for(items: usize) -> Self {
        Self { nodes: Vec::with_capacity(items / 8), leaves: Default::default(), depth: 0 }
    }

    /// Puts another behind, and returns its children as they are called here.
    fn append(&mut self, other: Self) -> impl Fn(Child) -> Child + use<> {
        let nodes = word(self.nodes.len());
        let leaves = self.leaves.each_ref().map(|leaves| word(leaves.len()));
        let moved = move |child: Child| match child.unpack() {
            Unpacked::Empty => child,
            Unpacked::Inner(index) => Child::inner(nodes + index),
            Unpacked::Leaf(kind, index) => Child::leaf(kind, leaves[kind as usize] + index),
        };
        let nodes = other.nodes.into_iter();
        self.nodes.extend(nodes.map(|node| Node { children: node.children.map(moved), ..node }));
        for (leaves, others) in self.leaves.iter_mut().zip(other.leaves) {
            leaves.extend(others);
        }
        self.depth = self.depth.max(other.depth);
        moved
    }
}

struct Writer<'a> {
    binary: &'a BinaryTree,
    costs: &'a Costs,
}

impl Writer<'_> {
    /// Appends the node of a run and all below it.
    fn write_node(&self, run: Run, depth: u32, part: &mut Part) -> Written {
        let index = part.nodes.len();
        part.nodes.push(Node::EMPTY);
        part.depth = part.depth.max(depth);
        let mut children = Children::default();
        self.spread(run, WIDTH, &mut children);
        let Children { runs, count } = children;
        let mut written = [Written { child: Child::EMPTY, cost: 0.0 }; WIDTH];
        let (runs, written) = (&runs[..count], &mut written[..count]);
        // To put parts together takes the time of copying, which is too much where there is nobody to share the rest with.
        if run.count >= PARALLEL && rayon::current_num_threads() > 1 {
            self.write_halves(runs, depth, part, written);
        } else {
            self.write_children(runs, depth, part, written);
        }
        let (node, mut cost) = (&mut part.nodes[index], 0.0);
        for (slot, (&run, written)) in runs.iter().zip(&*written).enumerate() {
            node.set(slot, self.bounds(run), written.child);
            cost += written.cost;
        }
        node.set_orders();
        Written { child: Child::inner(word(index)), cost }
    }

    /// Writes the children of one node, and all below them.
    fn write_children(&self, runs: &[Run], depth: u32, part: &mut Part, written: &mut [Written]) {
        for (&run, written) in runs.iter().zip(written) {
            let bounds = self.bounds(run);
            *written = if self.fork(run).is_none_or(|fork| fork.choices.is_leaf()) {
                let (child, kind, weight) = self.write_leaf(run, part);
                Written { child, cost: self.costs.of_child(bounds, Some((kind, weight))) }
            } else {
                let Written { child, cost } = self.write_node(run, depth + 1, part);
                Written { child, cost: self.costs.of_child(bounds, None) + cost }
            };
        }
    }

    /// Likewise, in two parts at a time.
    fn write_halves(&self, runs: &[Run], depth: u32, part: &mut Part, written: &mut [Written]) {
        let (all, mut before) = (runs.iter().map(|run| run.count).sum::<usize>(), 0);
        let is_left = |run: &&Run| {
            before += run.count;
            2 * before <= all + run.count
        };
        let (left_runs, right_runs) = runs.split_at(runs.iter().take_while(is_left).count());
        let (left, right) = written.split_at_mut(left_runs.len());
        let mut behind = Part::with_room_for(right_runs.iter().map(|run| run.count).sum());
        rayon::join(
            || self.write_children(left_runs, depth, part, left),
            || self.write_children(right_runs, depth, &mut behind, right),
        );
        let moved = part.append(behind);
        for written in right {
            written.child = moved(written.child);
        }
    }

    /// Returns the child, its kind and its weight.
    fn write_leaf(&self, run: Run, part: &mut Part) -> (Child, Kind, u32) {
        let references = &self.binary.references[run.first..run.first + run.count];
        let kind = references[0].kind();
        let weight = references.iter().map(|reference| u32::from(reference.weight())).sum();
        let leaves = &mut part.leaves[kind as usize];
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
            children.runs[children.count] = run;
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
