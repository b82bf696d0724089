//! Random numbers that are the same in every run: those of the film's samples.

use wavelane::film::SamplePattern;
use wavelane::scene::{RenderSettings, Sampling};

/// Numbers in [0, 1), two at a time.
pub(crate) struct Random(SamplePattern);

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        // With one sample a pixel it would lie in the middle.
        let settings = RenderSettings { sampling: Sampling::Random, samples: 8, seed, ..Default::default() };
        Self(SamplePattern::new(&settings))
    }

    /// A pair for each index and each `which` below 64.
    pub(crate) fn pair(&self, index: usize, which: u32) -> [f64; 2] {
        self.0.position(index as u32, 0, which)
    }
}
