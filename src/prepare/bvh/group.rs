//! What is known of a group of items as a whole.

use super::binary::Reference;
use super::{Bounds, Kind};
use glam::{Vec3A, Vec3Swizzles};
use rayon::prelude::*;

/// Items that one thread goes through at a time. Fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 1 << 15;

/// What some items cover, and what they weigh.
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
    /// A lane a [`Kind`].
    pub(super) weights: Vec3A,
}

impl Group {
    pub(super) const EMPTY: Self =
        Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY, weights: Vec3A::ZERO };

    pub(super) fn of(reference: &Reference) -> Self {
        const LANES: [Vec3A; Kind::COUNT] = [Vec3A::X, Vec3A::Y, Vec3A::Z];
        Self {
            low: reference.bounds.low.into(),
            high: reference.bounds.high.into(),
            weights: LANES[reference.kind as usize] * f32::from(reference.weight),
        }
    }

    pub(super) fn middle(&self) -> Vec3A {
        0.5 * self.low + 0.5 * self.high
    }

    pub(super) fn union(self, other: Self) -> Self {
        let weights = self.weights + other.weights;
        Self { low: self.low.min(other.low), high: self.high.max(other.high), weights }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.weights == Vec3A::ZERO
    }

    pub(super) fn is_of_one_kind(&self) -> bool {
        self.weights.cmpgt(Vec3A::ZERO).bitmask().count_ones() == 1
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { low: self.low.into(), high: self.high.into() }
    }

    /// Half of the surface area, of lengths times `scale`.
    pub(super) fn half_area(&self, scale: f32) -> f32 {
        let size = (self.high - self.low) * scale;
        size.dot(size.yzx())
    }
}

/// A group and the box of the middles of its items.
#[derive(Clone)]
pub(super) struct Spread {
    pub(super) group: Group,
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
}

impl Spread {
    const EMPTY: Self = Self { group: Group::EMPTY, low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    pub(super) fn of(references: &[Reference]) -> Self {
        let add = |spread: &mut Self, references: &[Reference]| {
            for reference in references {
                let group = Group::of(reference);
                let middle = group.middle();
                spread.group = spread.group.union(group);
                spread.low = spread.low.min(middle);
                spread.high = spread.high.max(middle);
            }
        };
        let join = |one: &mut Self, other: &Self| {
            one.group = one.group.union(other.group);
            one.low = one.low.min(other.low);
            one.high = one.high.max(other.high);
        };
        in_chunks(references, &Self::EMPTY, add, join)
    }
}

/// Goes through many items in parallel and joins the results in the order of the items.
#[inline]
pub(super) fn in_chunks<T: Clone + Send + Sync>(
    references: &[Reference],
    empty: &T,
    add: impl Fn(&mut T, &[Reference]) + Sync,
    join: impl Fn(&mut T, &T),
) -> T {
    let mut all = empty.clone();
    if references.len() <= CHUNK {
        add(&mut all, references);
        return all;
    }
    let chunks = references.par_chunks(CHUNK).map(|chunk| {
        let mut part = empty.clone();
        add(&mut part, chunk);
        part
    });
    for part in chunks.collect::<Vec<T>>() {
        join(&mut all, &part);
    }
    all
}
