//! Rays that have left the others: several at a time, a step of each in turn.
//!
//! A ray alone waits for memory at every step, and for the outcome of one test before it knows the next. While one waits the
//! others go on: what a step will read is asked for a round before.

use super::super::Counts;
use super::super::single::{self, Ray};
use super::STACK;
use super::rays::StreamRays;
use crate::lanes::{Lanes, Single};
use crate::prepare::bvh::{Child, Node, WIDTH};
use crate::prepare::{Hierarchy, Place};

/// Rays in turn: as many as it takes for memory to answer within a round.
const SLOTS: usize = 16;

pub(super) struct Loners {
    slots: Box<[Slot]>,
    /// Slots, those that are in use first.
    order: [u8; SLOTS],
    in_use: usize,
    /// Rays and where they are to go.
    queue: Vec<(u32, Child)>,
    /// Those before it have begun.
    begun: usize,
}

struct Slot {
    ray: Ray,
    number: u32,
    /// Children that wait, and where the ray enters them.
    waiting: usize,
    children: [Child; ROOM],
    enters: [f32; ROOM],
}

/// All children of a node may be written at once.
const ROOM: usize = STACK + WIDTH;

impl Loners {
    pub(super) fn new() -> Self {
        let slot = || Slot {
            ray: Ray::NONE,
            number: 0,
            waiting: 0,
            children: [Child::EMPTY; ROOM],
            enters: [0.0; ROOM],
        };
        let mut order = [0; SLOTS];
        for (place, slot) in (0..).zip(&mut order) {
            *slot = place;
        }
        Self { slots: (0..SLOTS).map(|_| slot()).collect(), order, in_use: 0, queue: Vec::new(), begun: 0 }
    }

    /// Sends a ray to what a slot of a node leads to.
    #[inline(always)]
    pub(super) fn push(&mut self, hierarchy: &Hierarchy, number: u32, child: Child) {
        hierarchy.prefetch(child);
        self.queue.push((number, child));
    }

    /// Whether as many wait as it pays to go on with.
    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.queue.len() >= SLOTS
    }

    /// Goes on as long as all slots are in use; to the end if nobody else will come.
    pub(super) fn run<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &mut StreamRays,
        is_last: bool,
        counts: &mut Counts,
    ) {
        loop {
            while self.in_use < SLOTS && self.begun < self.queue.len() {
                let slot = self.order[self.in_use];
                self.begin(slot, rays);
                self.in_use += 1;
            }
            if self.in_use == 0 || (self.in_use < SLOTS && !is_last) {
                self.queue.clear();
                self.begun = 0;
                return;
            }
            let mut place = 0;
            while place < self.in_use {
                let slot = self.order[place];
                let goes_on = self.slots[slot as usize].step::<F, DEPARTING, ANY>(hierarchy, rays, counts);
                if goes_on {
                    place += 1;
                } else if self.begun < self.queue.len() {
                    self.begin(slot, rays);
                    place += 1;
                } else {
                    self.in_use -= 1;
                    self.order.swap(place, self.in_use);
                }
            }
        }
    }

    fn begin(&mut self, slot: u8, rays: &StreamRays) {
        let (number, child) = self.queue[self.begun];
        self.begun += 1;
        let slot = &mut self.slots[slot as usize];
        rays.write_ray(number as usize, &mut slot.ray);
        slot.number = number;
        (slot.children[0], slot.enters[0]) = (child, 0.0);
        slot.waiting = 1;
    }
}

impl Slot {
    /// Visits a node or a leaf; false once there is none left.
    #[inline(always)]
    fn step<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &mut StreamRays,
        counts: &mut Counts,
    ) -> bool {
        let number = self.number as usize;
        let nearest = rays.nearest[number];
        if rays.is_done::<ANY>(number) {
            return false;
        }
        let end = nearest.end();
        let child = loop {
            if self.waiting == 0 {
                return false;
            }
            self.waiting -= 1;
            if self.enters[self.waiting] <= end {
                break self.children[self.waiting];
            }
        };
        match Hierarchy::place(child) {
            None => {}
            Some(Place::Node(index)) => {
                let node = &hierarchy.nodes[index];
                let slabs = self.ray.slabs();
                let (enters, bits) = single::enter_children::<F>(node, &self.ray, &slabs, end, counts);
                self.push::<F>(node, rays.class.octant(), bits, &enters);
            }
            Some(leaf) => {
                let found = (leaf, nearest);
                let nearest = single::visit_leaf::<F, DEPARTING, ANY>(hierarchy, &self.ray, found, counts);
                rays.keep::<ANY>(number, nearest);
            }
        }
        if self.waiting > 0 {
            hierarchy.prefetch(self.children[self.waiting - 1]);
        }
        self.waiting > 0
    }

    /// Puts those children of a node that the ray meets on the stack, the nearest on top: in the order that nodes hold for each
    /// octant, since to sort by where the ray enters is guesswork; and without a branch.
    #[inline(always)]
    fn push<F: Single>(&mut self, node: &Node, octant: usize, bits: u32, enters: &[f32; WIDTH]) {
        let order = node.orders[octant];
        let children = self.children[self.waiting..].first_chunk_mut();
        let places = children.zip(self.enters[self.waiting..].first_chunk_mut());
        // Elsewhere a shuffle is a loop of its own.
        let shuffles = cfg!(target_feature = "avx2") && F::Node::WIDTH == WIDTH;
        if let (Some((to_children, to_enters)), true) = (places, shuffles) {
            let arrangement = order.reversed(bits);
            arrangement.arrange(&node.children, to_children);
            arrangement.arrange(enters, to_enters);
            self.waiting += arrangement.count();
            return;
        }
        let mut waiting = self.waiting;
        for rank in (0..order.count()).rev() {
            let slot = order.slot(rank);
            (self.children[waiting], self.enters[waiting]) = (node.children[slot], enters[slot]);
            waiting += (bits >> slot & 1) as usize;
        }
        self.waiting = waiting;
    }
}
