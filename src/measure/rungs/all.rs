//! Every rung that a scene has.

use super::kernels::{BoxRung, KernelRungs, LeakRung};
use super::min_weight::MinWeightRung;
use super::samples::SamplesRung;
use super::{Progress, RungOptions};
use crate::lanes::Width;
use crate::measure::race::Race;
use crate::prepare::Prepared;
use crate::rays::{RayCounts, RayKind, RecordedRays};
use crate::render::RenderError;
use crate::scene::Scene;
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What accuracy costs on one scene, choice by choice.
#[derive(Clone, Debug, Serialize)]
pub struct Rungs {
    /// Formulas, for each kind of rays that test anything.
    pub kernels: Vec<KernelRungs>,
    /// Rays aimed at what triangles share; none where they share nothing that can be seen.
    pub leaks: Option<LeakRung>,
    /// Likewise for polygons.
    pub polygon_leaks: Option<LeakRung>,
    /// Rays aimed at corners that lie on an edge of their leaf's box; none where none does.
    pub box_corners: Option<BoxRung>,
    /// Frames without weak rays; none where nothing is reflected or refracted.
    pub min_weight: Option<MinWeightRung>,
    /// Small pictures by their samples.
    pub samples: SamplesRung,
}

impl Rungs {
    /// Measures them one after another. `frame` is how many rays the scene's frame has, `most_rays` how many of each kind are
    /// recorded for the formulas, about. [`RungOptions::on_progress`] hears of the steps of all rungs together, and once more
    /// when they are done.
    ///
    /// # Errors
    /// What keeps a scene from being rendered.
    pub fn measure(
        scene: &Scene,
        frame: RayCounts,
        most_rays: u64,
        options: &RungOptions<'_>,
    ) -> Result<Self, RenderError> {
        let prepared = Prepared::new(scene)?;
        let recorded = record(scene, frame, most_rays, options)?;
        let kinds = RayKind::ALL.into_iter().filter(|&kind| !recorded.of(kind).is_empty());
        let parts = Parts::new(kinds.clone().count(), options);

        let mut kernels = Vec::new();
        for (place, kind) in kinds.enumerate() {
            let rungs = parts
                .part(place, |options| KernelRungs::measure(&prepared, kind, recorded.of(kind), options))?;
            kernels.extend(Some(rungs).filter(|rungs| !rungs.is_empty()));
        }
        drop(recorded);
        let [leaks, polygon_leaks, box_corners, min_weight, samples] = parts.after_kernels();
        let leaks = parts.part(leaks, |options| LeakRung::of_triangles(&prepared, options))?;
        let polygon_leaks = parts.part(polygon_leaks, |options| LeakRung::of_polygons(&prepared, options))?;
        let box_corners = parts.part(box_corners, |options| BoxRung::at_corners(&prepared, options))?;
        let min_weight = parts.part(min_weight, |options| MinWeightRung::measure(scene, options))?;
        let samples = parts.part(samples, |options| SamplesRung::measure(scene, options))?;
        parts.finish();
        Ok(Self { kernels, leaks, polygon_leaks, box_corners, min_weight, samples })
    }
}

/// Rays as a comparison records them.
fn record(
    scene: &Scene,
    frame: RayCounts,
    most_rays: u64,
    options: &RungOptions<'_>,
) -> Result<RecordedRays, RenderError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let widths = &[Width::BEST];
    Race { scene, widths, repeat: 1, pool: &pool, stop: options.stop, on_step: &|| {} }
        .record(frame, most_rays)
}

/// Rungs measured one after another, whose steps are counted as one: as many as there may be, since a rung says only when it
/// is measured that the scene has no such rung.
struct Parts<'a> {
    options: &'a RungOptions<'a>,
    /// Steps of each part, at most.
    steps: Vec<usize>,
}

impl<'a> Parts<'a> {
    fn new(kinds: usize, options: &'a RungOptions<'a>) -> Self {
        let rounds = options.rounds();
        // Collecting pairs, and rounds of boxes, spheres, triangles and polygons; edges and corners, of triangles and of
        // polygons; corners of boxes; the truth; the truth and the error.
        let mut steps = vec![1 + 4 * rounds; kinds];
        steps.extend([2, 2, 1, 1 + rounds, 2 + rounds]);
        Self { options, steps }
    }

    /// The places of leaks, of triangles and of polygons, of corners of boxes, weak rays and samples.
    fn after_kernels(&self) -> [usize; 5] {
        [5, 4, 3, 2, 1].map(|from_end| self.steps.len() - from_end)
    }

    fn part<T>(&self, place: usize, measure: impl FnOnce(&RungOptions<'_>) -> T) -> T {
        let total = self.steps.iter().sum();
        let done = AtomicUsize::new(self.steps[..place].iter().sum());
        let on_progress = |progress: Progress| {
            let done = done.fetch_add(1, Ordering::Relaxed);
            (self.options.on_progress)(Progress { done, steps: total, ..progress });
        };
        measure(&RungOptions { on_progress: &on_progress, ..*self.options })
    }

    fn finish(&self) {
        let steps = self.steps.iter().sum();
        (self.options.on_progress)(Progress { what: "done", done: steps, steps });
    }
}
