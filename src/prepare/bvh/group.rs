//! What is known of a group of items as a whole.

use super::Kind;
use super::extent::Extent;
use super::reference::Reference;
use glam::{Vec3A, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;

/// Items that one thread goes through at a time. Fixed, so that sums do not depend on the number of threads.
pub(super) const CHUNK: usize = 1 << 15;

/// What some items cover, and what they weigh.
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub(super) extent: Extent,
    /// A lane a [`Kind`].
    pub(super) weights: Vec3A,
}

impl Group {
    pub(super) const EMPTY: Self = Self { extent: Extent::EMPTY, weights: Vec3A::ZERO };

    pub(super) fn of(reference: &Reference) -> Self {
        const LANES: [Vec3A; Kind::COUNT] = [Vec3A::X, Vec3A::Y, Vec3A::Z];
        Self {
            extent: reference.extent(),
            weights: LANES[reference.kind() as usize] * f32::from(reference.weight()),
        }
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self { extent: self.extent.union(other.extent), weights: self.weights + other.weights }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.weights == Vec3A::ZERO
    }

    pub(super) fn is_of_one_kind(&self) -> bool {
        self.weights.cmpgt(Vec3A::ZERO).bitmask().count_ones() == 1
    }

    /// All kinds that there are, and none beside where there is but one.
    pub(super) fn kinds(&self) -> Range<usize> {
        match self.weights.cmpgt(Vec3A::ZERO).bitmask() {
            0b001 => 0..1,
            0b010 => 1..2,
            0b100 => 2..3,
            _ => 0..Kind::COUNT,
        }
    }

    /// The kind of all of so many items, if they are of one and weigh 1 each. Of more than 2²⁴ it may take for one what weighs
    /// more: then a cut is chosen as if it did not.
    pub(super) fn kind_of_units(&self, count: usize) -> Option<usize> {
        let kinds = self.kinds();
        (kinds.len() == 1 && self.weights[kinds.start] == count as f32).then_some(kinds.start)
    }

    /// Half of the surface area, of lengths times `scale`.
    pub(super) fn half_area(&self, scale: f32) -> f32 {
        let size = self.extent.size() * scale;
        size.dot(size.yzx())
    }
}

/// A group and the box of the middles of its items.
#[derive(Clone, Copy)]
pub(super) struct Spread {
    pub(super) group: Group,
    pub(super) middles: Extent,
}

impl Spread {
    const EMPTY: Self = Self { group: Group::EMPTY, middles: Extent::EMPTY };

    pub(super) fn of(references: &[Reference]) -> Self {
        if references.len() <= CHUNK {
            return Self::of_chunk(references);
        }
        let chunks: Vec<Self> = references.par_chunks(CHUNK).map(Self::of_chunk).collect();
        chunks.iter().fold(Self::EMPTY, |all, chunk| Self {
            group: all.group.union(chunk.group),
            middles: all.middles.union(chunk.middles),
        })
    }

    fn of_chunk(references: &[Reference]) -> Self {
        references.iter().fold(Self::EMPTY, |all, reference| {
            let middles = Extent::of_point(reference.middle());
            Self { group: all.group.union(Group::of(reference)), middles: all.middles.union(middles) }
        })
    }
}
