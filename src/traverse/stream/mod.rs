//! Many rays that go the same way but are too unlike for a packet: at each node a list says which of them meet it, and the
//! lanes are rays of the list. No step waits for the one before, as those of a single ray do.
//!
//! - `rays`: what the tests need of each ray
//! - `leaf`: the rays of a list against what is in a leaf
//! - `later`: leaves of triangles whose memory has yet to come
//! - `loners`: rays that have left the others, several at a time
//!
//! This file makes the lists and walks.
//!
//! Sources: Barringer and Akenine-Möller, "Dynamic Ray Stream Traversal", 2014 (lists of rays at nodes); Fuetterling et al.,
//! "Efficient Ray Tracing Kernels for Modern CPU Architectures", 2015 (rays of one octant, whose order of children is known
//! before).

mod later;
mod leaf;
mod loners;
mod rays;

use super::regroup::Incoming;
use super::{Counts, Ends, child, tile};
use crate::lanes::{Lanes, Mask, Single, prefetch};
use crate::prepare::bvh::{DEPTH_LIMIT, Node, WIDTH};
use crate::prepare::{Hierarchy, Place};
use later::Later;
use leaf::{Listed, Tiled};
use loners::Loners;
pub(super) use rays::Class;
use rays::StreamRays;

/// Most rays of a stream; a power of two. The more there are, the longer the lists: with 2048, shadow, mirror and diffuse rays of
/// meshes were 1.04 times as fast as with 1024, with 4096 1.05 (2026-11).
pub(super) const CAPACITY: usize = 4096;

/// Rays of lists no longer than this go on alone, in lanes across boxes and primitives.
const FEW: usize = 3;

/// Likewise at polygons: one ray has their edges in lanes, many have one edge at a time.
const FEW_AT_POLYGONS: usize = 6;

/// Lists no longer than this meet triangles and spheres in tiles, without being asked once more whether they meet the leaf's
/// box. With 12, 16, 24, 32 and 64 all kinds of rays were as fast but for 2 %, without a limit mirror rays of the bunny at 0.9 of
/// the speed (2026-11).
const MOST_IN_TILES: usize = 24;

/// Children that wait: enough for the deepest tree, and one that may be written although no ray meets it.
const STACK: usize = DEPTH_LIMIT as usize * (WIDTH - 1) + 2;

/// Lists begin at multiples of this, and lanes may read and write so far beyond their ends.
const GAP: usize = 16;

/// So many rays before what is known of one is read or written, it is asked for.
pub(super) const AHEAD: usize = 48;

/// Rays of one [`Class`], and who of them meets which nodes.
pub(super) struct Stream {
    rays: StreamRays,
    /// Numbers of rays.
    lists: Vec<u32>,
    stack: Box<[Waiting; STACK]>,
    waiting: usize,
    loners: Loners,
    later: Later,
}

/// A child that waits with the rays that meet it: a part of the lists.
#[derive(Clone, Copy)]
struct Waiting {
    node: u32,
    slot: u32,
    first: u32,
    count: u32,
}

impl Stream {
    pub(super) fn new() -> Self {
        Self {
            rays: StreamRays::new(),
            lists: Vec::new(),
            stack: Box::new([Waiting { node: 0, slot: 0, first: 0, count: 0 }; STACK]),
            waiting: 0,
            loners: Loners::new(),
            later: Later::new(),
        }
    }

    /// Traces rays of one class, no more than [`CAPACITY`], of these places among those that came.
    pub(super) fn trace<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        incoming: &Incoming,
        (places, class): (&[u32], Class),
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        let room = (hierarchy.depth as usize + 1) * (WIDTH + 1) * (CAPACITY + 2 * GAP);
        if self.lists.len() < room {
            self.lists.resize(room, 0);
        }
        for (number, place) in (0..).zip(&mut self.lists[..places.len()]) {
            *place = number;
        }
        self.rays.load::<F::Node, DEPARTING>(hierarchy, incoming, places, class);
        self.walk::<F, DEPARTING, ANY>(hierarchy, places.len(), counts);
        for (number, &place) in places.iter().enumerate() {
            if let Some(&ahead) = places.get(number + AHEAD) {
                let row = incoming.rows[ahead as usize] as usize;
                prefetch(ends.t.as_ptr().wrapping_add(row).cast());
                if !ANY {
                    prefetch(ends.id.as_ptr().wrapping_add(row).cast());
                }
            }
            let row = incoming.rows[place as usize] as usize;
            let (t, id) = self.rays.end::<ANY>(hierarchy, number);
            ends.t[row] = t;
            if !ANY {
                ends.id[row] = id;
            }
        }
    }

    fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        count: usize,
        counts: &mut Counts,
    ) {
        self.waiting = 0;
        self.visit::<F>(hierarchy, 0, (0, count), counts);
        while self.waiting > 0 {
            self.waiting -= 1;
            let Waiting { node, slot, first, count } = self.stack[self.waiting];
            let node = &hierarchy.nodes[node as usize];
            let (slot, first, count) = (slot as usize, first as usize, count as usize);
            let child = node.children[slot];
            let Some(place) = Hierarchy::place(child) else { continue };
            let few = if matches!(place, Place::Polygons(..)) { FEW_AT_POLYGONS } else { FEW };
            let is_long = count > F::Node::WIDTH;
            match place {
                Place::Triangles(block) if count <= MOST_IN_TILES => {
                    if self.later.is_full() {
                        self.visit_waiting::<F, DEPARTING, ANY>(hierarchy, counts);
                    }
                    self.later.push(block, (&self.lists[first..], count));
                }
                Place::Spheres(block) if count <= MOST_IN_TILES => {
                    self.visit_spheres::<F, DEPARTING, ANY>(hierarchy, block, (first, count), counts);
                }
                _ if count <= few => {
                    for &number in &self.lists[first..first + count] {
                        self.loners.push(hierarchy, number, child);
                    }
                    if self.loners.is_full() {
                        self.loners.run::<F, DEPARTING, ANY>(hierarchy, &mut self.rays, false, counts);
                    }
                }
                Place::Node(index) if is_long => self.visit::<F>(hierarchy, index, (first, count), counts),
                Place::Node(index) => self.visit::<F::Node>(hierarchy, index, (first, count), counts),
                leaf if is_long => {
                    let of = (leaf, node, slot);
                    self.visit_leaf::<F, DEPARTING, ANY>(hierarchy, of, (first, count), counts);
                }
                leaf => {
                    let of = (leaf, node, slot);
                    self.visit_leaf::<F::Node, DEPARTING, ANY>(hierarchy, of, (first, count), counts);
                }
            }
        }
        while self.visit_waiting::<F, DEPARTING, ANY>(hierarchy, counts) {}
        self.loners.run::<F, DEPARTING, ANY>(hierarchy, &mut self.rays, true, counts);
    }

    /// Tests the triangles that have waited longest with the rays of their list; false if none wait.
    #[inline(never)]
    fn visit_waiting<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        counts: &mut Counts,
    ) -> bool {
        let Some(visit) = self.later.pop() else { return false };
        let (list, count) = visit.list();
        let rays = &mut Tiled::new(&mut self.rays, list);
        tile::triangles::<F, DEPARTING, ANY>(hierarchy, visit.block, (rays, count), counts);
        true
    }

    /// Tests the spheres of a leaf with the rays of a short list.
    #[inline(never)]
    fn visit_spheres<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        block: usize,
        (first, count): (usize, usize),
        counts: &mut Counts,
    ) {
        let rays = &mut Tiled::new(&mut self.rays, &self.lists[first..]);
        tile::spheres::<F, DEPARTING, ANY>(hierarchy, block, (rays, count), counts);
    }

    /// Puts the children that rays of a list meet on the stack, each with its list, the nearest on top.
    #[inline(never)]
    fn visit<L: Single>(
        &mut self,
        hierarchy: &Hierarchy,
        index: usize,
        (first, count): (usize, usize),
        counts: &mut Counts,
    ) {
        let node = &hierarchy.nodes[index];
        let class = self.rays.class;
        let order = node.orders[class.octant()];
        let children = order.count();
        // The list of the nearest child, which is walked first, lies last: what it leads to may take all room beyond it.
        let room = (count + 2 * GAP - 1) & !(GAP - 1);
        let base = (first + count + 2 * GAP - 1) & !(GAP - 1);
        let (before, lists) = self.lists.split_at_mut(base);
        let list = &before[first..];
        let mut ends = [0; WIDTH];
        for (rank, end) in ends[..children].iter_mut().enumerate() {
            *end = (children - 1 - rank) * room;
        }
        for place in (0..count).step_by(L::WIDTH) {
            let numbers = &list[place..];
            let ids = L::load_ids(numbers);
            let rays = self.rays.boxes::<L>(numbers);
            let in_list = L::first(count - place);
            for (rank, end) in ends[..children].iter_mut().enumerate() {
                let bits = (child::meet(&rays.slabs, (node, order.slot(rank)), class.backwards, rays.end)
                    & in_list)
                    .bits();
                L::pack_ids(ids, bits, &mut lists[*end..]);
                *end += bits.count_ones() as usize;
            }
            counts.boxes.calls += children as u64;
            counts.boxes.lanes += (children * L::WIDTH) as u64;
            counts.boxes.used += (children * L::WIDTH.min(count - place)) as u64;
        }
        let mut waiting = self.waiting;
        for rank in (0..children).rev() {
            let start = (children - 1 - rank) * room;
            let count = ends[rank] - start;
            // Without a branch: which children are met is anybody's guess.
            #[expect(
                clippy::cast_possible_truncation,
                reason = "nodes and places of lists are numbered in 32 bits"
            )]
            let entry = Waiting {
                node: index as u32,
                slot: order.slot(rank) as u32,
                first: (base + start) as u32,
                count: count as u32,
            };
            self.stack[waiting] = entry;
            waiting += usize::from(count > 0);
        }
        for entry in &self.stack[self.waiting..waiting] {
            hierarchy.prefetch(node.children[entry.slot as usize]);
        }
        self.waiting = waiting;
    }

    /// Tests what is in a leaf with those rays of a list that, with what they have found by now, still look for hits there.
    #[inline(never)]
    fn visit_leaf<L: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        (leaf, node, slot): (Place, &Node, usize),
        (first, count): (usize, usize),
        counts: &mut Counts,
    ) {
        for place in (0..count).step_by(L::WIDTH) {
            let numbers = &self.lists[first + place..];
            let rays = self.rays.boxes::<L>(numbers);
            let still = if ANY {
                // What is any hit's end is either where it was or nowhere.
                rays.end.ge(L::splat(0.0))
            } else {
                counts.boxes.add(L::WIDTH, L::WIDTH.min(count - place));
                child::meet(&rays.slabs, (node, slot), self.rays.class.backwards, rays.end)
            };
            let mask = still & L::first(count - place);
            if mask.any() {
                let used = mask.bits().count_ones() as usize;
                let mut rays = Listed::new(&mut self.rays, numbers, rays);
                super::leaf::visit::<L, _, DEPARTING, ANY>(
                    hierarchy,
                    (leaf, !0),
                    &mut rays,
                    (mask, used),
                    counts,
                );
            }
        }
    }
}
