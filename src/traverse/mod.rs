//! How rays walk the tree.
//!
//! - `candidate`: what counts as a hit of a primitive, for one pair of ray and primitive in each lane
//! - `exact`: which of two hits is the nearer, where f32 cannot tell
//! - `in_plane`: faces whose plane a ray starts in, for `exact`
//! - `single`: one ray at a time, its lanes across the children of a node and the primitives of a block
//! - `packet`: 64 rays at a time, their lanes across rays
//!
//! Both do the same arithmetic at the primitive, box tests never exclude a hit, and which of two hits is seen does not
//! depend on which is found first, so it does not show who walked. [`closest`] and [`occluded`] choose for each run of 64 rays.

mod candidate;
mod coherence;
mod counts;
mod exact;
mod in_plane;
mod packet;
mod single;
#[cfg(test)]
mod tests;

pub(crate) use counts::{Counts, LaneUse};
pub(crate) use single::{Ray as SingleRay, leaves};

use crate::lanes::Single;
use crate::prepare::Hierarchy;
use packet::{PACKET, Packet};

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

/// The closest hit of each ray.
pub(crate) fn closest<F: Single>(
    hierarchy: &Hierarchy,
    rays: &Rays<'_>,
    ends: &mut Ends<'_>,
    counts: &mut Counts,
) {
    if rays.departure.is_empty() {
        walk::<F, false, false>(hierarchy, rays, ends, counts);
    } else {
        walk::<F, true, false>(hierarchy, rays, ends, counts);
    }
}

/// Whether anything that casts a shadow is in the way of each ray.
pub(crate) fn occluded<F: Single>(
    hierarchy: &Hierarchy,
    rays: &Rays<'_>,
    ends: &mut Ends<'_>,
    counts: &mut Counts,
) {
    if rays.departure.is_empty() {
        walk::<F, false, true>(hierarchy, rays, ends, counts);
    } else {
        walk::<F, true, true>(hierarchy, rays, ends, counts);
    }
}

fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    rays: &Rays<'_>,
    ends: &mut Ends<'_>,
    counts: &mut Counts,
) {
    if hierarchy.nodes.is_empty() {
        return;
    }
    let mut packet = Packet::new();
    // Made once: to clear one for each ray took a fifth of the time of primary rays, 2026-11.
    let (mut packet_stack, mut single_stack) = (packet::EMPTY_STACK, single::EMPTY_STACK);
    for first in (0..rays.count).step_by(RUN) {
        let count = (rays.count - first).min(RUN);
        if packet.gather::<F>(hierarchy, rays, ends.t, first, count) {
            packet.walk::<F, DEPARTING, ANY>(hierarchy, &mut packet_stack, counts);
            packet.scatter::<ANY>(ends, first);
        } else {
            for row in first..first + count {
                let ray = single::Ray::new(hierarchy, rays, row);
                let (t, id) = single::walk::<F, DEPARTING, ANY>(
                    hierarchy,
                    &ray,
                    ends.t[row],
                    &mut single_stack,
                    counts,
                );
                ends.t[row] = t;
                if !ANY {
                    ends.id[row] = id;
                }
            }
        }
    }
}
