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
    pub(super) const EMPTY: Self = Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY, weights: Vec3A::ZERO };

    pub(super) fn add(&mut self, reference: &Reference) {
        const LANES: [Vec3A; Kind::COUNT] = [Vec3A::X, Vec3A::Y, Vec3A::Z];
        self.low = self.low.min(reference.bounds.low.into());
        self.high = self.high.max(reference.bounds.high.into());
        self.weights += LANES[reference.kind as usize] * f32::from(reference.weight);
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
pub(super) struct Spread {
    pub(super) group: Group,
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
}

impl Spread {
    const EMPTY: Self = Self { group: Group::EMPTY, low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    pub(super) fn of(references: &[Reference]) -> Self {
        let of_chunk = |chunk: &[Reference]| {
            let mut spread = Self::EMPTY;
            for reference in chunk {
                let middle = reference.middle();
                spread.group.add(reference);
                spread.low = spread.low.min(middle);
                spread.high = spread.high.max(middle);
            }
            spread
        };
        in_chunks(references, of_chunk, |one, other| Self {
            group: one.group.union(other.group),
            low: one.low.min(other.low),
            high: one.high.max(other.high),
        })
    }
}

/// Goes through many items in parallel and joins the results in the order of the items.
pub(super) fn in_chunks<T: Send>(
    references: &[Reference],
    of_chunk: impl Fn(&[Reference]) -> T + Sync,
    join: impl Fn(T, T) -> T,
) -> T {
    let (first, rest) = references.split_at(references.len().min(CHUNK));
    if rest.is_empty() {
        return of_chunk(first);
    }
    let (first, rest): (T, Vec<T>) =
        rayon::join(|| of_chunk(first), || rest.par_chunks(CHUNK).map(&of_chunk).collect());
    rest.into_iter().fold(first, join)
}
