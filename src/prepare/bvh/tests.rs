//! What every tree must be, whatever it is built of.

use super::*;
use glam::Vec3;
use proptest::prelude::*;

const KINDS: [Kind; 3] = [Kind::Sphere, Kind::Triangle, Kind::Polygon];
const COSTS: Costs = Costs {
    node: 1.0,
    node_memory: 0.0,
    block: [1.0; 3],
    room: [4.0, 4.0, 1.0],
    largest_leaf: 4,
    stays_whole: [false; 3],
};

fn triangle(low: Vec3, high: Vec3) -> Item {
    Item { bounds: Bounds { low, high }, kind: Kind::Triangle, weight: 1 }
}

/// Boxes of side up to `size` in the unit cube, by Knuth's multiplier for 64 bits.
fn scattered(count: usize, size: f32) -> Vec<Item> {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        f32::from((state >> 48) as u16) / 65536.0
    };
    let mut point = || Vec3::new(random(), random(), random());
    let boxes = std::iter::repeat_with(|| {
        let low = point();
        triangle(low, low + size * point())
    });
    boxes.take(count).collect()
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![(-4..=4_i8).prop_map(f32::from), -4.0..4.0_f32]
}

fn item() -> impl Strategy<Value = Item> {
    let point = || [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from);
    let kind = prop_oneof![4 => Just(Kind::Triangle), 1 => Just(Kind::Sphere), 1 => Just(Kind::Polygon)];
    (point(), point(), kind, 0..9_u16).prop_map(|(one, other, kind, weight)| {
        let bounds = Bounds { low: one.min(other), high: one.max(other) };
        Item { bounds, kind, weight }
    })
}

/// A walk that holds a tree against the items that it was built of.
struct Walk<'a> {
    tree: &'a Tree,
    items: &'a [Item],
    costs: &'a Costs,
    nodes: u32,
    /// By kind.
    leaves: [u32; Kind::COUNT],
    placed: u32,
}

impl Walk<'_> {
    /// Returns the box of all items below a node, and how deep it goes.
    fn node(&mut self, index: u32) -> (Bounds, u32) {
        assert_eq!(index, self.nodes, "nodes are not in the order of the walk");
        self.nodes += 1;
        let node = &self.tree.nodes[index as usize];
        let used = node.children.iter().filter(|&&child| child != Child::EMPTY).count();
        let leaves: usize = self.tree.leaves.iter().map(Vec::len).sum();
        assert!(used >= 2 || leaves == 1, "{used} children");
        let (mut all, mut depth) = (Bounds::EMPTY, 0);
        for (slot, child) in node.children.iter().enumerate() {
            let (bounds, below) = match child.unpack() {
                Unpacked::Empty => (Bounds::EMPTY, 0),
                Unpacked::Inner(index) => self.node(index),
                Unpacked::Leaf(kind, index) => (self.leaf(kind, index), 0),
            };
            assert_eq!(*child == Child::EMPTY, slot >= used, "children do not come first");
            assert_eq!(node.bounds(slot), bounds, "a box is not that of its items");
            all = all.union(bounds);
            depth = depth.max(below);
        }
        (all, depth + 1)
    }

    fn leaf(&mut self, kind: Kind, index: u32) -> Bounds {
        assert_eq!(index, self.leaves[kind as usize], "leaves are not in the order of the walk");
        self.leaves[kind as usize] += 1;
        let leaf = self.tree.leaves[kind as usize][index as usize];
        assert_eq!(leaf.first, self.placed);
        assert!((1..=self.costs.largest_leaf).contains(&leaf.count), "{} items", leaf.count);
        self.placed += leaf.count;
        let run = &self.tree.order[leaf.first as usize..self.placed as usize];
        let items = run.iter().map(|&index| self.items[index as usize]);
        assert!(items.clone().all(|item| item.kind == kind));
        items.fold(Bounds::EMPTY, |all, item| all.union(item.bounds))
    }
}

/// What a random ray that meets the root's box is expected to cost, from the finished tree.
fn sah_cost(tree: &Tree, items: &[Item], costs: &Costs) -> f64 {
    let Some(root) = tree.nodes.first() else { return 0.0 };
    let of_leaf = |kind: Kind, leaf: Leaf| {
        let run = &tree.order[leaf.first as usize..][..leaf.count as usize];
        let weight: u32 = run.iter().map(|&index| u32::from(items[index as usize].weight.max(1))).sum();
        (f64::from(weight) / f64::from(costs.room[kind as usize])).ceil()
            * f64::from(costs.block[kind as usize])
    };
    let of_slot = |node: &Node, slot: usize| {
        let cost = match node.children[slot].unpack() {
            Unpacked::Empty => return 0.0,
            Unpacked::Inner(_) => f64::from(costs.node),
            Unpacked::Leaf(kind, leaf) => of_leaf(kind, tree.leaves[kind as usize][leaf as usize]),
        };
        node.bounds(slot).half_area() * cost
    };
    let below: f64 = tree.nodes.iter().flat_map(|node| (0..WIDTH).map(move |slot| of_slot(node, slot))).sum();
    let area = (0..WIDTH).fold(Bounds::EMPTY, |all, slot| all.union(root.bounds(slot))).half_area();
    f64::from(costs.node) + if area > 0.0 { below / area } else { 0.0 }
}

fn built(items: &[Item], costs: &Costs) -> Tree {
    build(items.par_iter().copied(), costs)
}

fn check(items: &[Item], costs: &Costs) -> Tree {
    let tree = built(items, costs);
    let mut order = tree.order.clone();
    order.sort_unstable();
    assert!(order.into_iter().eq(0..word(items.len())), "an item is missing or there twice");
    let mut walk = Walk { tree: &tree, items, costs, nodes: 0, leaves: [0; Kind::COUNT], placed: 0 };
    let depth = match tree.root.unpack() {
        Unpacked::Empty => 0,
        Unpacked::Inner(root) => walk.node(root).1,
        Unpacked::Leaf(..) => panic!("the root is a leaf"),
    };
    assert_eq!(depth, tree.depth);
    assert!(depth <= DEPTH_LIMIT);
    let reached = (walk.nodes as usize, walk.leaves.map(|count| count as usize), walk.placed as usize);
    assert_eq!(reached, (tree.nodes.len(), tree.leaves.each_ref().map(Vec::len), items.len()));
    assert_eq!(tree.bounds, items.iter().fold(Bounds::EMPTY, |all, item| all.union(item.bounds)));
    let cost = sah_cost(&tree, items, costs);
    assert!((tree.cost - cost).abs() <= 1e-9 * cost, "says that it costs {}, and costs {cost}", tree.cost);
    tree
}

proptest! {
    #[test]
    fn trees_hold_every_item_once_in_boxes_that_are_exact(
        items in prop::collection::vec(item(), 0..300),
        exponent in -140..60_i32,
        largest_leaf in 1..9_u32,
        stays_whole in prop::array::uniform3(any::<bool>()),
    ) {
        // In two steps, of which each is a normal number.
        let (half, rest) = (exponent / 2, exponent - exponent / 2);
        let scaled = |point: Vec3| point * 2.0_f32.powi(half) * 2.0_f32.powi(rest);
        let items: Vec<Item> = items
            .into_iter()
            .map(|item| Item {
                bounds: Bounds { low: scaled(item.bounds.low), high: scaled(item.bounds.high) },
                ..item
            })
            .collect();
        check(&items, &Costs { largest_leaf, stays_whole, ..COSTS });
    }
}

#[test]
fn trees_of_nothing_and_of_one_item() {
    let empty = check(&[], &COSTS);
    assert_eq!((empty.root, empty.depth, empty.cost), (Child::EMPTY, 0, 0.0));
    let one = check(&[triangle(Vec3::ZERO, Vec3::ONE)], &COSTS);
    assert_eq!((one.nodes.len(), one.depth), (1, 1));
    assert_eq!(one.nodes[0].children[0].unpack(), Unpacked::Leaf(Kind::Triangle, 0));
    // One node and one block, which every ray meets.
    assert_eq!(one.cost, 2.0);
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let mut items = scattered(400_000, 0.02);
    for (item, kind) in items.iter_mut().zip(KINDS.into_iter().cycle()) {
        item.kind = kind;
    }
    let trees = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| built(&items, &COSTS));
        let planes = tree.nodes.iter().flat_map(|node| [node.low, node.high]);
        let bits: Vec<u32> = planes.flat_map(|planes| planes.concat()).map(f32::to_bits).collect();
        (bits, tree)
    });
    assert!(trees[1] == trees[0] && trees[2] == trees[0]);
    check(&items, &COSTS);
}

#[test]
fn items_that_no_cut_tells_apart_are_halved() {
    let same = triangle(Vec3::ONE, Vec3::splat(2.0));
    let tree = check(&vec![same; 1_000_000], &COSTS);
    assert!(tree.depth <= 10, "depth {}", tree.depth);
    // All in one point: boxes without area still make full nodes.
    let tree = check(&vec![triangle(Vec3::ONE, Vec3::ONE); 100_000], &COSTS);
    assert!(tree.depth <= 8, "depth {}", tree.depth);
    // One inside the other.
    let nested = |step: u16| triangle(Vec3::splat(-f32::from(step)), Vec3::splat(f32::from(step)));
    check(&(0..10_000).map(nested).collect::<Vec<_>>(), &COSTS);
    // In one place, but of different kinds.
    let mixed: Vec<Item> = (0..10_000).map(|index| Item { kind: KINDS[index % 3], ..same }).collect();
    check(&mixed, &COSTS);
}

#[test]
fn the_depth_is_bounded_where_every_cut_parts_few_from_the_rest() {
    let powers = (-140..120).flat_map(|exponent| [exponent; 50]);
    let items = powers.map(|exponent| {
        let place = 2.0_f32.powi(exponent / 2) * 2.0_f32.powi(exponent - exponent / 2);
        triangle(Vec3::splat(place), Vec3::splat(1.5 * place))
    });
    check(&items.collect::<Vec<_>>(), &COSTS);
}

#[test]
fn coordinates_may_be_flat_or_as_large_as_they_get() {
    let flat = |item: Item| {
        let on_floor = |point: Vec3| point.with_z(0.0);
        triangle(on_floor(item.bounds.low), on_floor(item.bounds.high))
    };
    check(&scattered(1000, 0.1).into_iter().map(flat).collect::<Vec<_>>(), &COSTS);
    for scale in [1e18, f32::MAX / 2.0] {
        let grown = |item: Item| {
            let place = |point: Vec3| (2.0 * point - 1.0).clamp(Vec3::NEG_ONE, Vec3::ONE) * scale;
            triangle(place(item.bounds.low), place(item.bounds.high))
        };
        let tree = check(&scattered(1000, 0.1).into_iter().map(grown).collect::<Vec<_>>(), &COSTS);
        assert!(tree.cost.is_finite());
    }
    let ends = [-f32::MAX, f32::MAX].map(|x| triangle(Vec3::splat(x), Vec3::splat(x)));
    check(&ends.repeat(100), &COSTS);
}

/// Appends the node over `items`, parted into eight of the same size by halving along the longest axis.
fn halved(items: &mut [(u32, Item)], tree: &mut Tree) -> (Bounds, Child) {
    fn halvings<'a>(items: &'a mut [(u32, Item)], times: u32, parts: &mut Vec<&'a mut [(u32, Item)]>) {
        if times == 0 || items.len() < 2 {
            return parts.push(items);
        }
        let bounds = items.iter().fold(Bounds::EMPTY, |all, item| all.union(item.1.bounds));
        let axis = (bounds.high - bounds.low).max_position();
        items.sort_by(|one, other| one.1.bounds.low[axis].total_cmp(&other.1.bounds.low[axis]));
        let (left, right) = items.split_at_mut(items.len() / 2);
        halvings(left, times - 1, parts);
        halvings(right, times - 1, parts);
    }
    let bounds = items.iter().fold(Bounds::EMPTY, |all, item| all.union(item.1.bounds));
    if items.len() <= COSTS.largest_leaf as usize {
        let (first, count) = (word(tree.order.len()), word(items.len()));
        tree.leaves[Kind::Triangle as usize].push(Leaf { first, count });
        tree.order.extend(items.iter().map(|item| item.0));
        return (bounds, Child::leaf(Kind::Triangle, word(tree.leaves[Kind::Triangle as usize].len() - 1)));
    }
    let index = tree.nodes.len();
    tree.nodes.push(Node::EMPTY);
    let mut parts = Vec::new();
    halvings(items, 3, &mut parts);
    for (slot, part) in parts.into_iter().enumerate() {
        let (bounds, child) = halved(part, tree);
        tree.nodes[index].set(slot, bounds, child);
    }
    (bounds, Child::inner(word(index)))
}

#[test]
fn a_tree_costs_clearly_less_than_halving_by_count() {
    // A dense cluster among few large boxes: what the heuristic is for.
    let mut items = scattered(2000, 0.3);
    items.extend(scattered(8000, 0.02).into_iter().map(|item| {
        let place = |point: Vec3| 0.4 + 0.1 * point;
        triangle(place(item.bounds.low), place(item.bounds.high))
    }));
    let cost = check(&items, &COSTS).cost;
    let mut tree = Tree {
        nodes: vec![],
        leaves: Default::default(),
        order: vec![],
        root: Child::inner(0),
        bounds: Bounds::EMPTY,
        depth: 0,
        cost: 0.0,
    };
    halved(&mut (0..).zip(items.iter().copied()).collect::<Vec<_>>(), &mut tree);
    let of_halving = sah_cost(&tree, &items, &COSTS);
    assert!(cost < 0.8 * of_halving, "{cost} against {of_halving}");
}

#[test]
fn of_kinds_that_stay_whole_leaves_are_not_parted() {
    // Far apart, so that each by itself would cost less.
    let apart = |count: u8| -> Vec<Item> {
        let low = |index: u8| Vec3::splat(100.0 * f32::from(index));
        (0..count).map(|index| triangle(low(index), low(index) + 1.0)).collect()
    };
    let leaves = |count: u8, stays_whole| check(&apart(count), &Costs { stays_whole, ..COSTS }).leaves;
    let is_triangle = [Kind::Sphere, Kind::Triangle, Kind::Polygon].map(|kind| kind == Kind::Triangle);
    assert_eq!(leaves(4, [false; 3])[Kind::Triangle as usize].len(), 4);
    assert_eq!(leaves(4, is_triangle.map(|is| !is))[Kind::Triangle as usize].len(), 4);
    assert_eq!(leaves(4, is_triangle)[Kind::Triangle as usize].len(), 1);
    assert_eq!(leaves(5, is_triangle)[Kind::Triangle as usize].len(), 2);
}

#[test]
fn what_costs_more_goes_into_smaller_leaves() {
    let polygons: Vec<Item> = scattered(1000, 0.1)
        .into_iter()
        .map(|item| Item { kind: Kind::Polygon, weight: 5, ..item })
        .collect();
    let fill = |costs: &Costs| {
        let tree = check(&polygons, costs);
        polygons.len() as f64 / tree.leaves[Kind::Polygon as usize].len() as f64
    };
    let cheap = Costs { block: [0.01; 3], ..COSTS };
    assert!(fill(&COSTS) < fill(&cheap), "{} against {}", fill(&COSTS), fill(&cheap));
}
