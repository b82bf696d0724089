//! One scene: seconds by phase and by stage, rays a second by kind, lanes in use, memory, and whether the answers are right.

use super::super::race::{Frames, Race, speed_up};
use super::super::{Better, HitErrors, Spread};
use crate::film::{self, BitDepth, Image};
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::rays::{RayCounts, RayKind};
use crate::reference::Tracer;
use crate::render::RenderError;
use crate::scene::Scene;
use crate::trace::Query;
use crate::wavefront::StageTotal;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// How to measure.
pub struct BenchOptions<'a> {
    /// Where the work is done.
    pub pool: &'a rayon::ThreadPool,
    /// Timed frames, and passes over recorded rays, of each engine; one more goes before them.
    pub repeat: usize,
    /// About as many rays of each kind are traced on their own.
    pub rays: u64,
    /// A folder for pictures that are written for the sake of the time that takes.
    pub scratch: &'a Path,
    /// Called after each of [`SceneBench::steps`].
    pub on_step: &'a dyn Fn(),
    /// Set to true, makes it stop soon.
    pub stop: &'a AtomicBool,
}

/// What was measured of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneBench {
    /// Its file, or the name of a standard scene.
    pub scene: String,
    /// Spheres, triangles and polygons.
    pub primitives: usize,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// n of n × n samples a pixel.
    pub samples: u32,
    /// The deepest ray.
    pub max_depth: u32,
    /// Of a frame.
    pub rays: RayCounts,
    /// Of the simd engine.
    pub seconds: PhaseSeconds,
    /// At one lane.
    pub scalar: EngineBench,
    /// At the widest lanes that pay.
    pub simd: EngineBench,
    /// Of a frame, simd over scalar.
    pub speed_up: Option<f64>,
    /// Of some of the rays that were traced on their own.
    pub errors: BTreeMap<RayKind, HitErrors>,
    /// Bytes held.
    pub memory: SceneMemory,
}

/// Wall-clock seconds by phase.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PhaseSeconds {
    /// Reading and checking the file, once; none where there is none.
    pub load: Option<f64>,
    /// Making the scene ready.
    pub build: Option<Spread>,
    /// The part of a frame in which rays are intersected.
    pub trace: Option<f64>,
    /// The rest of the frame.
    pub shade: Option<f64>,
    /// Encoding and writing a PNG.
    pub write: Option<Spread>,
}

/// One engine.
#[derive(Clone, Debug, Serialize)]
pub struct EngineBench {
    /// Of f32.
    pub lanes: u32,
    /// To trace and shade a frame.
    pub frame_seconds: Option<Spread>,
    /// Of the last frame.
    pub stages: Vec<StageTotal>,
    /// On recorded rays, by kind; kinds without rays are left out.
    pub mrays_per_second: BTreeMap<RayKind, Option<Spread>>,
}

/// Bytes held.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SceneMemory {
    /// The hierarchy, with all that rays are tested against.
    pub hierarchy_bytes: usize,
    /// Of the hierarchy, a primitive; none in an empty scene.
    pub bytes_per_primitive: Option<f64>,
    /// Queues of the worker that held most.
    pub queue_bytes_per_worker: usize,
}

/// Scalar and the widest that pays.
const WIDTHS: [Width; 2] = [Width::One, Width::BEST];

/// Of each kind about so many rays are held against the reference.
const CHECKED_RAYS: usize = 1 << 14;

impl SceneBench {
    /// How often [`BenchOptions::on_step`] is called.
    #[must_use]
    pub fn steps(repeat: usize) -> u64 {
        let passes = Race::steps(WIDTHS.len(), repeat);
        // Frames, and for each kind of ray passes and errors.
        passes + RayKind::ALL.len() as u64 * (passes + 1)
    }

    /// Measures a scene that took some seconds to load, if it was loaded.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn measure(
        name: &str,
        scene: &Scene,
        load_seconds: Option<f64>,
        options: &BenchOptions<'_>,
    ) -> Result<Self, RenderError> {
        let race = Race {
            scene,
            widths: &WIDTHS,
            repeat: options.repeat,
            pool: options.pool,
            stop: options.stop,
            on_step: options.on_step,
        };
        let frames = race.frames()?;
        let [scalar, simd] = frames.as_slice() else { return Err(RenderError::Stopped) };
        let recorded = race.record(simd.last.rays, options.rays)?;
        let prepared = options.pool.install(|| Prepared::new(scene))?;
        let tracer = Tracer::new(scene, options.stop);
        let mut rates = [BTreeMap::new(), BTreeMap::new()];
        let mut errors = BTreeMap::new();
        for kind in RayKind::ALL {
            let (rays, query) = (recorded.of(kind), Query::of(kind));
            if rays.is_empty() {
                (0..=Race::steps(WIDTHS.len(), options.repeat)).for_each(|_| (options.on_step)());
                continue;
            }
            let passes = race.passes(&prepared, query, rays);
            for (rates, passes) in rates.iter_mut().zip(&passes) {
                rates.insert(kind, passes.mrays_per_second);
            }
            let every = rays.len().div_ceil(CHECKED_RAYS);
            let hits = &passes[WIDTHS.len() - 1].hits;
            let checked = || HitErrors::measure_every(every, &tracer, rays, query, hits);
            errors.insert(kind, options.pool.install(checked));
            (options.on_step)();
        }
        let [scalar_rates, simd_rates] = rates;
        Ok(Self {
            scene: name.to_owned(),
            primitives: scene.geometry.primitive_count(),
            size: [scene.image.width, scene.image.height],
            samples: scene.render.samples,
            max_depth: scene.render.max_depth,
            rays: simd.last.rays,
            seconds: PhaseSeconds::of(&frames, simd, load_seconds, options),
            speed_up: speed_up(scalar.trace_seconds, simd.trace_seconds),
            scalar: EngineBench::new(WIDTHS[0], scalar, scalar_rates),
            simd: EngineBench::new(WIDTHS[1], simd, simd_rates),
            errors,
            memory: SceneMemory::of(scene, simd),
        })
    }

    /// Rays whose answer is wrong, though no rounding explains it.
    #[must_use]
    pub fn mistakes(&self) -> u64 {
        self.errors.values().map(HitErrors::mistakes).sum()
    }
}

impl PhaseSeconds {
    fn of(all: &[Frames], simd: &Frames, load: Option<f64>, options: &BenchOptions<'_>) -> Self {
        let build = all.iter().flat_map(|frames| frames.prepare_seconds.iter().copied()).collect();
        let stages = simd.last.wavefront.as_ref().map(|report| &report.stage_seconds);
        let traced = stages.and_then(|seconds| {
            let all: f64 = seconds.values().sum();
            let traced = seconds.get("intersect")? + seconds.get("occlude")?;
            (all > 0.0).then(|| traced / all)
        });
        let frame = simd.trace_seconds.map(|seconds| seconds.median);
        let write = (0..options.repeat).map_while(|_| write_seconds(&simd.last.image, options)).collect();
        Self {
            load,
            build: Spread::of(build, Better::Less),
            trace: frame.zip(traced).map(|(frame, traced)| frame * traced),
            shade: frame.zip(traced).map(|(frame, traced)| frame * (1.0 - traced)),
            write: Spread::of(write, Better::Less),
        }
    }
}

/// None where it cannot be written.
fn write_seconds(image: &Image, options: &BenchOptions<'_>) -> Option<f64> {
    let path = options.scratch.join("frame.png");
    let start = Instant::now();
    options.pool.install(|| film::write(image, &path, BitDepth::Eight)).ok()?;
    Some(start.elapsed().as_secs_f64())
}

impl EngineBench {
    fn new(width: Width, frames: &Frames, mrays_per_second: BTreeMap<RayKind, Option<Spread>>) -> Self {
        let stages = frames.last.wavefront.as_ref().map(|report| report.stage_totals.clone());
        let frame_seconds = frames.trace_seconds;
        Self { lanes: width.lanes(), frame_seconds, stages: stages.unwrap_or_default(), mrays_per_second }
    }
}

impl SceneMemory {
    fn of(scene: &Scene, frames: &Frames) -> Self {
        let memory = frames.last.wavefront.as_ref().map(|report| report.memory);
        let hierarchy_bytes = memory.map_or(0, |memory| memory.hierarchy_bytes);
        let primitives = scene.geometry.primitive_count();
        Self {
            hierarchy_bytes,
            bytes_per_primitive: (primitives > 0).then(|| hierarchy_bytes as f64 / primitives as f64),
            queue_bytes_per_worker: memory.map_or(0, |memory| memory.queue_bytes_per_worker),
        }
    }
}
