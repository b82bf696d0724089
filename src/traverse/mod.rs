//! How rays walk the tree.
//!
//! - `candidate`: what counts as a hit of a primitive, for one pair of ray and primitive in each lane
//! - `exact`: which of two hits is the nearer, where f32 cannot tell
//! - `in_plane`: faces whose plane a ray starts in, for `exact`
//! - `packet`: 64 rays at a time that are much alike, their lanes across rays
//! - `stream`: up to 4096 rays that go roughly the same way; at each node a list says who of them meets it
//! - `single`: one ray, its lanes across the children of a node and the primitives of a block; what few rays of a stream are
//!   left to
//! - `leaf`: what is in a leaf against rays in lanes, for packets and streams
//! - `tile`: what is in a leaf against pairs of ray and primitive in lanes, for few rays of a packet or stream and for one alone
//! - `child`: the box of a child against rays in lanes, likewise
//! - `edges`: which edges of a polygon rays that lie side by side have to do with
//! - `sight`: bounds of what several rays see, for `edges` and for triangles that packets miss
//! - `terms`: what the tests need of a ray beside origin and direction, for streams and rays alone
//! - `coherence`, `regroup`: which rays are alike, and how others are put together
//! - `shuffled`: rays that come in no order, sorted before threads share them
//!
//! All do the same arithmetic at the primitive, box tests never exclude a hit, and which of two hits is seen does not
//! depend on which is found first, so it does not show who walked. A [`Walker`] chooses for each run of 64 rays.

mod candidate;
mod child;
mod coherence;
mod counts;
mod edges;
mod exact;
mod in_plane;
mod leaf;
mod packet;
mod regroup;
mod shuffled;
mod sight;
mod single;
mod stream;
mod terms;
#[cfg(test)]
mod tests;
mod tile;

pub(crate) use counts::{Counts, LaneUse};
pub(crate) use shuffled::{Shuffled, is_local};
pub(crate) use single::{Ray as SingleRay, leaves};

use crate::lanes::Single;
use crate::prepare::Hierarchy;
use packet::{PACKET, Packet};
use regroup::{Incoming, WINDOW};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use stream::Stream;

/// Rays in columns, in runs of [`RUN`]: where the last run is not full, rows that cannot hit fill it, with t < 0.
pub(crate) struct Rays<'a> {
    pub(crate) origin: [&'a [f32]; 3],
    /// What the rounding of a start to f32 left out; empty where no ray starts on a primitive.
    pub(crate) origin_low: [&'a [f32]; 3],
    /// Of any length but 0, near 1 so that squares do not overflow.
    pub(crate) direction: [&'a [f32]; 3],
    /// Twice the id of the primitive that the ray starts on, plus 1 if it goes inside; [`NOWHERE`] if it starts on none.
    /// Empty where no ray starts on a primitive.
    pub(crate) departure: &'a [u32],
    /// Hits are wanted beyond this t; empty where that is 0 or where rays start on primitives.
    pub(crate) t_min: &'a [f32],
    /// How many there are, without those that fill up.
    pub(crate) count: usize,
}

impl<'a> Rays<'a> {
    /// The first row of each run of [`RUN`] rows, and how many of them are rays.
    fn runs(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let count = self.count;
        (0..count).step_by(RUN).map(move |first| (first, (count - first).min(RUN)))
    }

    /// Those of some whole runs of rows.
    pub(crate) fn rows(&self, rows: Range<usize>) -> Rays<'a> {
        fn of<'a, T>(rows: &Range<usize>, column: &'a [T]) -> &'a [T] {
            column.get(rows.clone()).unwrap_or(&[])
        }
        Rays {
            origin: self.origin.map(|column| of(&rows, column)),
            origin_low: self.origin_low.map(|column| of(&rows, column)),
            direction: self.direction.map(|column| of(&rows, column)),
            departure: of(&rows, self.departure),
            t_min: of(&rows, self.t_min),
            count: rows.len().min(self.count - rows.start),
        }
    }
}

/// Where rays end.
pub(crate) struct Ends<'a> {
    /// Before: hits are wanted at t_min < t < this. After: the nearest of them where there is one; for an occluded ray, below 0.
    pub(crate) t: &'a mut [f32],
    /// After: the id of what is hit there, [`NOTHING`] where nothing is. Empty if it is only asked whether rays are
    /// occluded.
    pub(crate) id: &'a mut [u32],
}

/// Columns are as long as a multiple of this.
pub(crate) const RUN: usize = PACKET;
/// Not a departure.
pub(crate) const NOWHERE: u32 = u32::MAX;
/// Not an id.
pub(crate) const NOTHING: u32 = u32::MAX;
/// t of a row that cannot hit, and of a ray that is known to be occluded.
pub(crate) const DEAD: f32 = -1.0;

/// Runs that are left to streams after a packet that was dear, before one is tried again: one run, and each time that one is
/// dear again twice as many, up to this.
const RUNS_WITHOUT: usize = 16;

/// Boxes, or groups of eight, that are tested for a packet above which it is dear: its rays are so far apart, or geometry so
/// fine, that it goes nearly everywhere for the sake of a few rays. Of packets that tested up to 2 for each ray streams were
/// slower, by up to half (five scenes of 7000 to 2 million primitives, `gears` and `shells` of the SPD; primary and shadow
/// rays, 2026-11); at 2.1 to 2.7 both were as fast; from 3 on streams were faster, by up to 1.7 times. Tests of primitives do
/// not tell: those of large polygons, or of spheres that lie in each other, are many for a stream as well.
const DEAR_BOXES: u64 = 5 * RUN as u64 / 2;

/// Finds what rays hit. Its memory is used again for every batch.
pub(crate) struct Walker {
    packets: Packets,
    incoming: Incoming,
    stream: Stream,
}

/// Walks runs of rays that are alike.
struct Packets {
    packet: Box<Packet>,
    stack: Box<packet::Stack>,
    /// Runs to be left to streams, and how many after the next that is dear.
    runs_without: usize,
    next_runs_without: usize,
}

impl Packets {
    /// Before rays of another batch.
    fn begin(&mut self) {
        (self.runs_without, self.next_runs_without) = (0, 1);
        self.packet.clear();
    }

    /// Walks a run of [`RUN`] rows, `count` of which are rays, if they are alike.
    #[inline(always)]
    fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        (first, count): (usize, usize),
        counts: &mut Counts,
    ) -> bool {
        if self.runs_without > 0 || !self.packet.gather::<F>(hierarchy, rays, ends.t, first, count) {
            self.runs_without = self.runs_without.saturating_sub(1);
            return false;
        }
        let boxes = counts.boxes.calls;
        self.packet.walk::<F, DEPARTING, ANY>(hierarchy, &mut self.stack, counts);
        self.packet.scatter::<ANY>(ends, first);
        if counts.boxes.calls - boxes > DEAR_BOXES {
            self.runs_without = self.next_runs_without;
            self.next_runs_without = (2 * self.next_runs_without).min(RUNS_WITHOUT);
        } else {
            self.next_runs_without = 1;
        }
        true
    }
}

impl Walker {
    pub(crate) fn new() -> Self {
        Self {
            packets: Packets {
                packet: Box::new(Packet::new()),
                stack: Box::new(packet::EMPTY_STACK),
                runs_without: 0,
                next_runs_without: 1,
            },
            incoming: Incoming::default(),
            stream: Stream::new(),
        }
    }

    /// The closest hit of each ray.
    pub(crate) fn closest<F: Single>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        self.trace::<F, false>(hierarchy, rays, ends, counts);
    }

    /// Whether anything that casts a shadow is in the way of each ray.
    pub(crate) fn occluded<F: Single>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        self.trace::<F, true>(hierarchy, rays, ends, counts);
    }

    fn trace<F: Single, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        if rays.departure.is_empty() {
            self.walk::<F, false, ANY>(hierarchy, rays, ends, counts);
        } else {
            self.walk::<F, true, ANY>(hierarchy, rays, ends, counts);
        }
    }

    fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        if hierarchy.nodes.is_empty() {
            return;
        }
        self.incoming.clear();
        self.packets.begin();
        for run in rays.runs() {
            if !self.packets.walk::<F, DEPARTING, ANY>(hierarchy, rays, ends, run, counts) {
                self.incoming.push_run::<F, DEPARTING>(rays, ends.t, run);
                if self.incoming.len() >= WINDOW {
                    self.stream::<F, DEPARTING, ANY>(hierarchy, ends, counts);
                }
            }
        }
        self.stream::<F, DEPARTING, ANY>(hierarchy, ends, counts);
    }

    /// Walks runs of rays that are alike, and puts the others aside.
    fn packets<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        ends: &mut Ends<'_>,
        aside: &mut Incoming,
        counts: &mut Counts,
    ) {
        self.packets.begin();
        for run in rays.runs() {
            if !self.packets.walk::<F, DEPARTING, ANY>(hierarchy, rays, ends, run, counts) {
                aside.push_run::<F, DEPARTING>(rays, ends.t, run);
            }
        }
    }

    /// Traces rays that were put aside.
    fn streams<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        take_in: impl FnOnce(&mut Incoming),
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        self.incoming.clear();
        take_in(&mut self.incoming);
        self.stream::<F, DEPARTING, ANY>(hierarchy, ends, counts);
    }

    /// Traces those that packets left.
    fn stream<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        ends: &mut Ends<'_>,
        counts: &mut Counts,
    ) {
        let Self { incoming, stream, .. } = self;
        incoming.each_part(|incoming, places, class| {
            stream.trace::<F, DEPARTING, ANY>(hierarchy, incoming, (places, class), ends, counts);
        });
        incoming.clear();
    }
}

/// Walkers that threads share; one that none uses is lent again.
#[derive(Default)]
pub(crate) struct Walkers(Mutex<Vec<Walker>>);

impl Walkers {
    pub(crate) fn lend<T>(&self, work: impl FnOnce(&mut Walker) -> T) -> T {
        // Whatever a thread that panicked left there is as good as new.
        let idle = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let walker = idle().pop();
        let mut walker = walker.unwrap_or_else(Walker::new);
        let done = work(&mut walker);
        idle().push(walker);
        done
    }
}

/// How many rays of many that come in an order to give to a walker at a time: little enough to share among threads.
pub(crate) fn batch(count: usize, threads: usize) -> usize {
    /// So many for each thread, where rays are enough: one that is done sooner takes another's.
    const SHARES: usize = 4;
    const LEAST: usize = WINDOW / 4;
    let shares = count.div_ceil(threads * WINDOW).max(if threads > 1 { SHARES } else { 1 });
    count.div_ceil(threads * shares).clamp(LEAST, WINDOW).next_multiple_of(RUN)
}
