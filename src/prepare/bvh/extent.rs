//! Boxes as they are joined to others.

use super::Bounds;
use crate::lanes::{EightSingles, Lanes};
use glam::Vec3A;

/// −low in the first four lanes and high in the last, so that one maximum takes in another box. The fourth lanes of both mean
/// nothing.
#[derive(Clone, Copy)]
pub(super) struct Extent(EightSingles);

impl Extent {
    pub(super) const EMPTY: Self = Self(EightSingles::new([f32::NEG_INFINITY; 8]));

    #[inline(always)]
    pub(super) fn of_ends(ends: &[f32; 8]) -> Self {
        Self(EightSingles::new(*ends))
    }

    #[inline(always)]
    pub(super) fn of_point(point: Vec3A) -> Self {
        let ([a, b, c], [x, y, z]) = ((-point).to_array(), point.to_array());
        Self(EightSingles::new([a, b, c, 0.0, x, y, z, 0.0]))
    }

    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        Self(Lanes::max(self.0, other.0))
    }

    /// Itself or nothing, without a branch, which nothing could foresee.
    #[inline(always)]
    pub(super) fn only_if(self, is_there: bool) -> Self {
        const ADDED: [f32; 2] = [f32::NEG_INFINITY, 0.0];
        Self(self.0 + EightSingles::splat(ADDED[usize::from(is_there)]))
    }

    #[inline(always)]
    fn corners(self) -> [Vec3A; 2] {
        let [a, b, c, _, x, y, z, _] = self.0.to_array();
        [Vec3A::new(a, b, c), Vec3A::new(x, y, z)]
    }

    #[inline(always)]
    pub(super) fn low(self) -> Vec3A {
        -self.corners()[0]
    }

    #[inline(always)]
    pub(super) fn high(self) -> Vec3A {
        self.corners()[1]
    }

    #[inline(always)]
    pub(super) fn size(self) -> Vec3A {
        let [minus_low, high] = self.corners();
        high + minus_low
    }

    /// Halved before the sum so that it does not overflow.
    #[inline(always)]
    pub(super) fn middle(self) -> Vec3A {
        let [minus_low, high] = self.corners();
        0.5 * high - 0.5 * minus_low
    }

    pub(super) fn bounds(self) -> Bounds {
        Bounds { low: self.low().into(), high: self.high().into() }
    }
}
