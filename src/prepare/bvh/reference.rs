//! An item on its way into place.

use super::{Bounds, Item, Kind};
use glam::{Vec3A, Vec4};

/// Two vectors of four lanes, so that a box is loaded as it lies: its corners, and in the fourth lanes, as bits, which item
/// this is and what it weighs.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(super) struct Reference {
    low: [f32; 4],
    high: [f32; 4],
}

const _: () = assert!(size_of::<Reference>() == 32);

impl Reference {
    /// Set in the fourth lanes, which go through the arithmetic of the others unused: so they hold no subnormal numbers, with
    /// which some processors take long.
    const TAG: u32 = 1 << 30;

    pub(super) fn new(index: u32, item: Item) -> Self {
        let Item { bounds: Bounds { low, high }, kind, weight } = item;
        let of_kind = (kind as u32) << 16 | u32::from(weight.max(1));
        let lane = |bits: u32| f32::from_bits(bits | Self::TAG);
        Self { low: low.extend(lane(index)).to_array(), high: high.extend(lane(of_kind)).to_array() }
    }

    pub(super) fn index(&self) -> u32 {
        self.low[3].to_bits() & !Self::TAG
    }

    pub(super) fn kind(&self) -> Kind {
        match self.high[3].to_bits() >> 16 & 3 {
            0 => Kind::Sphere,
            1 => Kind::Triangle,
            _ => Kind::Polygon,
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "the low half is what is meant")]
    pub(super) fn weight(&self) -> u16 {
        (self.high[3].to_bits() & u32::from(u16::MAX)) as u16
    }

    pub(super) fn low(&self) -> Vec3A {
        Vec3A::from_vec4(Vec4::from_array(self.low))
    }

    pub(super) fn high(&self) -> Vec3A {
        Vec3A::from_vec4(Vec4::from_array(self.high))
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { low: self.low().into(), high: self.high().into() }
    }

    /// The middle of its box, halved before the sum so that it does not overflow.
    pub(super) fn middle(&self) -> Vec3A {
        0.5 * self.low() + 0.5 * self.high()
    }

    /// The same along one axis.
    pub(super) fn middle_along(&self, axis: usize) -> f32 {
        0.5 * self.low[axis] + 0.5 * self.high[axis]
    }
}
