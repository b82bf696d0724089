//! Where the samples of a pixel lie: a pure function of seed, pixel and sample, so that no order of work can change it.

use crate::random::random_unit;
use crate::scene::{RenderSettings, Sampling};

/// The samples of every pixel of an image.
#[derive(Clone, Copy, Debug)]
pub struct SamplePattern {
    sampling: Sampling,
    n: u32,
    seed: u32,
}

impl SamplePattern {
    /// The pattern that a scene asks for.
    #[must_use]
    pub fn new(settings: &RenderSettings) -> Self {
        Self { sampling: settings.sampling, n: settings.samples, seed: settings.seed }
    }

    /// Samples a pixel, n².
    #[must_use]
    pub fn count(&self) -> u32 {
        self.n * self.n
    }

    /// (ξ, η) of sample s = q·n + p of pixel (x, y): the share of the pixel to the left of the sample, and the share
    /// below it. The pixel is counted from the full image's top left.
    #[must_use]
    pub fn position(&self, x: u32, y: u32, s: u32) -> [f64; 2] {
        // A single sample lies in the middle, whatever the pattern: a picture without antialiasing is not noisy.
        if self.n == 1 {
            return [0.5, 0.5];
        }
        let n = f64::from(self.n);
        let (p, q) = (f64::from(s % self.n), f64::from(s / self.n));
        let random = |dimension| random_unit([self.seed, x, y, s, dimension]);
        match self.sampling {
            Sampling::Regular => [(p + 0.5) / n, (q + 0.5) / n],
            Sampling::Random => [random(0), random(1)],
            Sampling::Jittered => [(p + random(0)) / n, (q + random(1)) / n],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(sampling: Sampling, samples: u32) -> SamplePattern {
        SamplePattern::new(&RenderSettings { sampling, samples, seed: 7, ..RenderSettings::default() })
    }

    #[test]
    fn a_single_sample_is_the_middle_of_the_pixel() {
        for (_, sampling) in Sampling::NAMES {
            assert_eq!(pattern(sampling, 1).position(5, 9, 0), [0.5, 0.5], "{sampling:?}");
        }
    }

    #[test]
    fn regular_samples_run_along_u_first() {
        let pattern = pattern(Sampling::Regular, 2);
        let positions: Vec<_> = (0..pattern.count()).map(|s| pattern.position(0, 0, s)).collect();
        assert_eq!(positions, [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]);
    }

    #[test]
    fn each_cell_holds_one_jittered_sample() {
        let n = 8;
        let pattern = pattern(Sampling::Jittered, n);
        for (x, y) in [(0, 0), (3, 1), (4000, 123)] {
            let samples: Vec<_> = (0..pattern.count()).map(|s| pattern.position(x, y, s)).collect();
            for cell in (0..n * n).map(|cell| [cell % n, cell / n].map(f64::from)) {
                let is_inside =
                    |[xi, eta]: &&[f64; 2]| [xi * f64::from(n), eta * f64::from(n)].map(f64::floor) == cell;
                assert_eq!(samples.iter().filter(is_inside).count(), 1, "cell {cell:?} of pixel ({x}, {y})");
            }
        }
    }

    /// Variance of the estimate that a half-plane covers of a pixel, over many pixels.
    fn spread_of_coverage(sampling: Sampling) -> f64 {
        let pattern = pattern(sampling, 4);
        let pixels = 2000;
        let coverage = |x| {
            let inside = (0..pattern.count())
                .map(|s| pattern.position(x, 1, s))
                .filter(|[xi, eta]| 0.3 * xi + eta < 0.6)
                .count();
            inside as f64 / f64::from(pattern.count())
        };
        let values: Vec<f64> = (0..pixels).map(coverage).collect();
        let mean = values.iter().sum::<f64>() / f64::from(pixels);
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / f64::from(pixels)
    }

    #[test]
    fn random_samples_spread_more_than_jittered_ones() {
        let (random, jittered) =
            (spread_of_coverage(Sampling::Random), spread_of_coverage(Sampling::Jittered));
        // 16 independent samples of an area of 0.45 vary by 0.45·0.55/16.
        let expected = 0.45 * 0.55 / 16.0;
        assert!((random / expected - 1.0).abs() < 0.15, "random spread {random}, expected {expected}");
        assert!(jittered < random / 3.0, "jittered {jittered} against random {random}");
    }

    /// Other programs predict these: worked out step by step with 32-bit arithmetic outside this program.
    #[test]
    fn random_samples_follow_the_published_recipe() {
        // Seed 7, x 300, y 21, sample 6 of 4 × 4: p = 2, q = 1.
        let [xi, eta] = [1102339.0, 1709377.0].map(|random| random / 16_777_216.0);
        assert_eq!(pattern(Sampling::Random, 4).position(300, 21, 6), [xi, eta]);
        assert_eq!(
            pattern(Sampling::Jittered, 4).position(300, 21, 6),
            [(2.0 + xi) / 4.0, (1.0 + eta) / 4.0]
        );
    }
}
