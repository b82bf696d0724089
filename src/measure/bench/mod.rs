//! How fast scenes are rendered, phase by phase and stage by stage, scalar beside SIMD, and how cost grows.
//!
//! - `scene`: one scene
//! - `growth`: cost over primitives, pixels, threads, samples, lights and levels of rays
//! - `baseline`: what got slower since an earlier report

mod baseline;
mod growth;
mod scene;

pub use baseline::{Baseline, BaselineError, Change};
pub use growth::{Growth, GrowthPoint};
pub use scene::{BenchOptions, EngineBench, PhaseSeconds, SceneBench, SceneMemory};

use super::Machine;
use serde::Serialize;

/// The report of a benchmark.
#[derive(Clone, Debug, Serialize)]
pub struct BenchReport {
    /// [`Self::FORMAT`].
    pub format: u32,
    /// Where it was made.
    pub machine: Machine,
    /// Worker threads.
    pub threads: usize,
    /// The scenes, in the order in which they ran.
    pub scenes: Vec<SceneBench>,
    /// How cost grows.
    pub growth: Vec<Growth>,
}

impl BenchReport {
    /// Changes when a report's numbers mean something else, so that they are not held against others.
    pub const FORMAT: u32 = 1;
}
