//! An item on its way into place.

use super::extent::Extent;
use super::{Bounds, Item, Kind};
use glam::Vec3A;

/// The lanes of an [`Extent`], so that a box is loaded as it lies; in the fourth lanes, as bits, which item this is and what it
/// weighs.
#[repr(C, align(32))]
#[derive(Clone, Copy)]
pub(super) struct Reference([f32; 8]);

const _: () = assert!(size_of::<Reference>() == 32);

impl Reference {
    /// Set in the fourth lanes, which go through the arithmetic of the others unused: so they hold no subnormal numbers, with
    /// which some processors take long.
    const TAG: u32 = 1 << 30;

    pub(super) fn new(index: u32, item: Item) -> Self {
        let Item { bounds: Bounds { low, high }, kind, weight } = item;
        let of_kind = (kind as u32) << 16 | u32::from(weight.max(1));
        let lane = |bits: u32| f32::from_bits(bits | Self::TAG);
        let (low, high) = ((-low).to_array(), high.to_array());
        Self([low[0], low[1], low[2], lane(index), high[0], high[1], high[2], lane(of_kind)])
    }

    pub(super) fn index(&self) -> u32 {
        self.0[3].to_bits() & !Self::TAG
    }

    pub(super) fn kind(&self) -> Kind {
        match self.0[7].to_bits() >> 16 & 3 {
            0 => Kind::Sphere,
            1 => Kind::Triangle,
            _ => Kind::Polygon,
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "the low half is what is meant")]
    pub(super) fn weight(&self) -> u16 {
        (self.0[7].to_bits() & u32::from(u16::MAX)) as u16
    }

    #[inline(always)]
    pub(super) fn extent(&self) -> Extent {
        Extent::of_ends(&self.0)
    }

    pub(super) fn bounds(&self) -> Bounds {
        self.extent().bounds()
    }

    #[inline(always)]
    pub(super) fn middle(&self) -> Vec3A {
        self.extent().middle()
    }

    /// The same along one axis.
    pub(super) fn middle_along(&self, axis: usize) -> f32 {
        0.5 * self.0[4 + axis] - 0.5 * self.0[axis]
    }
}
