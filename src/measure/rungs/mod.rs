//! The rungs: each choice that trades speed for accuracy, run as variants, each with its speed beside its error.
//!
//! - `kernels`: formulas for the tests of rays against spheres and triangles, on a frame's own rays
//! - `min_weight`: leaving out rays that carry little light
//! - `samples`: how many samples a pixel, and where they lie
//!
//! All is the same from run to run but for times. Nothing that is undefined gets a number: a rung that a scene does not have
//! is none, and so is a percentile of nothing.

pub mod kernels;
pub mod min_weight;
pub mod samples;
mod table;

use crate::lanes::Width;
use crate::render::RenderError;
use std::sync::atomic::{AtomicBool, Ordering};

/// How to measure.
pub struct RungOptions<'a> {
    /// Lanes of the wavefront engine and of its kernels.
    pub width: Width,
    /// Threads for whatever is not timed on one; 0 for one a core.
    pub threads: usize,
    /// How often each variant is timed, in turn with the others; at least once.
    pub repeats: usize,
    /// Called before each step.
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
    /// Set to true, makes the measurement stop soon.
    pub stop: &'a AtomicBool,
}

/// How far a measurement is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub what: &'static str,
    /// Steps that are done.
    pub done: usize,
    /// Steps of the rung.
    pub steps: usize,
}

impl RungOptions<'_> {
    fn rounds(&self) -> usize {
        self.repeats.max(1)
    }

    /// Says what comes next, unless it is told to stop.
    fn step(&self, what: &'static str, done: usize, steps: usize) -> Result<(), RenderError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(RenderError::Stopped);
        }
        (self.on_progress)(Progress { what, done, steps });
        Ok(())
    }
}

/// The middle number, of an even count the upper of the two; none of nothing.
fn median(numbers: &[f64]) -> Option<f64> {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_of_the_sorted_numbers() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[5.0]), Some(5.0));
        assert_eq!(median(&[]), None);
    }
}
