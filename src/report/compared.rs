//! A comparison with what it was made of, how and where; this is its JSON.

use crate::measure::rungs::Rungs;
use crate::measure::{Comparison, Machine};
use crate::scene::Scene;
use serde::Serialize;

/// All that there is to say of a comparison.
#[derive(Serialize)]
pub(crate) struct Compared {
    /// The scene file, as it was named.
    pub(crate) scene: String,
    /// A command line that does the same again.
    pub(crate) command: String,
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    /// `regular`, `random` or `jittered`.
    pub(crate) sampling: &'static str,
    /// n of n × n samples a pixel.
    pub(crate) samples: u32,
    /// What random samples start from.
    pub(crate) seed: u32,
    /// The deepest ray.
    pub(crate) max_depth: u32,
    /// Rays of less weight are not spawned.
    pub(crate) min_weight: f32,
    /// Spheres, triangles and polygons.
    pub(crate) primitives: usize,
    pub(crate) machine: Machine,
    #[serde(flatten)]
    pub(crate) comparison: Comparison,
    /// What accuracy costs, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rungs: Option<Rungs>,
}

impl Compared {
    /// What has just been measured of a scene, here and now.
    pub(crate) fn new(
        scene: &Scene,
        name: String,
        command: String,
        comparison: Comparison,
        rungs: Option<Rungs>,
    ) -> Self {
        Self {
            scene: name,
            command,
            size: [scene.image.width, scene.image.height],
            sampling: scene.render.sampling.name(),
            samples: scene.render.samples,
            seed: scene.render.seed,
            max_depth: scene.render.max_depth,
            min_weight: scene.render.min_weight,
            primitives: scene.geometry.primitive_count(),
            machine: Machine::here_and_now(),
            comparison,
            rungs,
        }
    }

    /// The settings in a line, and the machine in another.
    pub(crate) fn title(&self) -> String {
        let [width, height] = self.size;
        format!(
            "{}: {width} x {height} pixels, samples a pixel: {}, primitives: {}, rays to depth {}\n\
             {}, threads: {}, built for {}",
            self.scene,
            u64::from(self.samples).pow(2),
            self.primitives,
            self.max_depth,
            self.machine.processor.as_deref().unwrap_or("unknown processor"),
            self.comparison.threads,
            self.machine.isa,
        )
    }
}
