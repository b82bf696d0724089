//! Random numbers that are the same in every run.

use glam::{DQuat, DVec3};

/// SplitMix64: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
pub(super) struct Random(u64);

impl Random {
    /// Each list of words begins a sequence of its own.
    pub(super) fn new(words: &[u64]) -> Self {
        let mut this = Self(0);
        for word in words {
            this.0 = this.next() ^ word;
        }
        this
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Their logarithms evenly.
    pub(super) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// From low to high, both included.
    pub(super) fn whole(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low + 1) as usize) as i64
    }

    pub(super) fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    pub(super) fn pick<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.below(of.len())]
    }

    /// Less than a count that is not 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.next()) * count as u128) >> 64) as usize
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    pub(super) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// Of length 1, in any direction alike: Marsaglia, "Choosing a Point from the Surface of a Sphere", 1972.
    pub(super) fn direction(&mut self) -> DVec3 {
        loop {
            let [x, y] = [self.between(-1.0, 1.0), self.between(-1.0, 1.0)];
            let square = x * x + y * y;
            if square < 1.0 {
                let root = 2.0 * (1.0 - square).sqrt();
                return DVec3::new(x * root, y * root, 1.0 - 2.0 * square);
            }
        }
    }

    pub(super) fn turn(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), self.between(0.0, std::f64::consts::TAU))
    }

    /// A share of an edge: now and then a multiple of 1/2, 1/4, … 1/256.
    pub(super) fn share_of_an_edge(&mut self) -> f64 {
        if self.chance(0.6) { self.unit() } else { self.dyadic() }
    }

    /// Between 0 and 1, a multiple of 1/2, 1/4, … 1/256.
    pub(super) fn dyadic(&mut self) -> f64 {
        let parts = 2 << self.below(8);
        (1 + self.below(parts - 1)) as f64 / parts as f64
    }
}
