//! What a run did and how long it took, as JSON.

use super::Machine;
use crate::lanes::Isa;
use crate::rays::RayCounts;
use crate::wavefront::WavefrontReport;
use serde::Serialize;

/// The report of one render.
#[derive(Clone, Debug, Serialize)]
pub struct RenderReport {
    /// The program's version.
    pub version: &'static str,
    /// The scene file.
    pub scene: String,
    /// The picture file.
    pub output: String,
    /// Which engine traced.
    pub engine: &'static str,
    /// How many rays its kernels take at once.
    pub lanes: u32,
    /// The instruction set that the program was built for.
    pub isa: Isa,
    /// Worker threads.
    pub threads: usize,
    /// Width and height of the full image, pixels.
    pub size: [u32; 2],
    /// Width and height of what was rendered of it, pixels.
    pub rendered: [u32; 2],
    /// Where samples lie: `regular`, `random` or `jittered`.
    pub sampling: &'static str,
    /// n of n × n samples a pixel.
    pub samples: u32,
    /// The deepest ray.
    pub max_depth: u32,
    /// Spheres, triangles and polygons.
    pub primitives: usize,
    /// Rays traced, by kind.
    pub rays: RayCounts,
    /// Wall-clock time by phase.
    pub seconds: Seconds,
    /// The most memory that the process has had at one time; none where the system does not say.
    pub peak_resident_bytes: Option<u64>,
    /// Where and when this was.
    pub machine: Machine,
    /// What the stages of the wavefront engine did; absent for the reference.
    #[serde(flatten)]
    pub wavefront: Option<WavefrontReport>,
}

/// Wall-clock time by phase, seconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading and checking files.
    pub load: f64,
    /// Building what the engine runs on.
    pub prepare: f64,
    /// Tracing all rays.
    pub trace: f64,
    /// Encoding and writing the picture.
    pub write: f64,
    /// From the first to the last.
    pub total: f64,
}
