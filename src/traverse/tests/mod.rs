//! However rays are grouped and whatever the width, a walk finds what a loop over every primitive finds.

mod brute_force;
mod error_bounds;
mod grazing;
mod rays;
mod same_as_all;
mod scenes;
mod streams;
mod touching;
mod watertight;

/// Knuth's generator for 64 bits: many numbers from one seed, the same on every machine.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of things in memory"
    )]
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    pub(super) fn vector(&mut self) -> glam::DVec3 {
        [(); 3].map(|()| self.between(-1.0, 1.0)).into()
    }
}
