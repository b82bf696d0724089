//! Speed against error: every engine on one scene, the f64 reference being the truth.

use super::agreement::{self, Distance};
use super::race::{Frames, Passes, Race, has_same_bits, mrays_per_second, speed_up};
use super::{Better, HitErrors, Spread};
use crate::film::Image;
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::rays::{RayCounts, RayKind, RaySet};
use crate::reference::{Precision, Tracer};
use crate::render::{Engine, RenderError};
use crate::scene::Scene;
use crate::trace::{Query, ReferenceRun};
use serde::Serialize;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// How to compare.
pub struct ComparisonOptions<'a> {
    /// Worker threads; 0 for one a core.
    pub threads: usize,
    /// Timed frames and passes of each wavefront engine; one more goes before them. The reference, which is slow, has one.
    pub repeat: usize,
    /// About as many rays of each kind are traced on their own, and looked at one by one.
    pub rays: u64,
    /// Called with the steps done so far and those there will be.
    pub on_progress: &'a dyn Fn(u64, u64),
    /// Set to true, makes it stop soon.
    pub stop: &'a AtomicBool,
}

/// Every engine on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Of the picture.
    pub pixels: u64,
    /// Rays of the frame, as the wavefront engine traces them.
    pub frame_rays: RayCounts,
    /// Rays of the frame that were traced on their own.
    pub recorded_rays: RayCounts,
    /// Threads that were used.
    pub threads: usize,
    /// Seconds to make the scene ready for the wavefront engine.
    pub build_seconds: Option<Spread>,
    /// The truth first, then the wavefront engine at one lane and more.
    pub engines: Vec<EngineResult>,
    /// How far a picture is off the truth whose only fault is that its queues hold f32: no such engine comes nearer.
    pub floor: Distance,
}

/// One engine: how fast, and how wrong.
#[derive(Clone, Debug, Serialize)]
pub struct EngineResult {
    /// `reference`, `scalar` or `simd`.
    pub engine: &'static str,
    /// Of f32; the reference has one of f64.
    pub lanes: u32,
    /// Seconds to trace and shade the frame, once the scene is ready.
    pub frame_seconds: Option<Spread>,
    /// Of the frame, over `scalar`; ratio of medians.
    pub speed_up: Option<f64>,
    /// On recorded rays, by kind; kinds without rays are left out.
    pub mrays_per_second: BTreeMap<RayKind, Option<Spread>>,
    /// On the same rays.
    pub hits: BTreeMap<RayKind, HitErrors>,
    /// The picture against the truth, linear.
    pub image: Distance,
    /// Whether picture and hits have the bits that those of `scalar` have; none for the reference.
    pub same_bits_as_scalar: Option<bool>,
}

/// What the picture of an engine looks like, and what it should look like.
pub struct ComparedImages {
    /// By the reference.
    pub truth: Image,
    /// By the reference with queues of f32.
    pub floor: Image,
    /// By the wavefront engine at its widest.
    pub engine: Image,
}

impl Comparison {
    /// What shows: a step of an 8-bit channel.
    pub const LIMIT: f64 = Distance::LIMIT;

    /// Renders a scene with every engine and traces its rays with each.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn measure(
        scene: &Scene,
        options: &ComparisonOptions<'_>,
    ) -> Result<(Self, ComparedImages), RenderError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
        let passes = Race::steps(Width::ALL.len(), options.repeat);
        let kinds = RayKind::ALL.len() as u64;
        // The reference's frame, frames, the recording; for each kind of ray passes, the reference's, errors; the floor.
        let steps = 1 + passes + 1 + kinds * (passes + 2) + 1;
        let done = Cell::new(0);
        let step = || (options.on_progress)(done.replace(done.get() + 1) + 1, steps);
        let race = Race {
            scene,
            widths: &Width::ALL,
            repeat: options.repeat,
            pool: &pool,
            stop: options.stop,
            on_step: &step,
        };

        let truth = race.render(Engine::Reference)?;
        step();
        let frames = race.frames()?;
        let recorded = race.record(frames[0].last.rays, options.rays)?;
        step();
        let prepared = pool.install(|| Prepared::new(scene))?;
        let traced: Vec<TracedKind> = RayKind::ALL
            .into_iter()
            .filter(|&kind| {
                let is_there = !recorded.of(kind).is_empty();
                (0..if is_there { 0 } else { passes + 2 }).for_each(|_| step());
                is_there
            })
            .map(|kind| TracedKind::measure(&race, &prepared, kind, recorded.of(kind)))
            .collect();
        let floor = floor(&race)?;
        step();

        let mut engines = vec![of_reference(truth.trace_seconds, frames[0].trace_seconds, &traced)];
        engines.extend((0..frames.len()).map(|turn| of_wavefront(turn, &frames, &truth.image, &traced)));
        let build_seconds = frames.iter().flat_map(|frames| frames.prepare_seconds.iter().copied()).collect();
        let comparison = Self {
            pixels: truth.image.pixels.len() as u64,
            frame_rays: frames[0].last.rays,
            recorded_rays: recorded.counts(),
            threads: pool.current_num_threads(),
            build_seconds: Spread::of(build_seconds, Better::Less),
            engines,
            floor: Distance::between(&truth.image, &floor),
        };
        let engine = frames.into_iter().last().map_or_else(|| floor.clone(), |frames| frames.last.image);
        Ok((comparison, ComparedImages { truth: truth.image, floor, engine }))
    }

    /// Rays whose answer is wrong, though no rounding explains it: of any engine.
    #[must_use]
    pub fn mistakes(&self) -> u64 {
        self.engines.iter().flat_map(|engine| engine.hits.values()).map(HitErrors::mistakes).sum()
    }
}

/// Rays of a kind, traced by every engine.
struct TracedKind {
    kind: RayKind,
    /// Mrays/s.
    reference: Option<Spread>,
    /// By width.
    passes: Vec<Passes>,
    errors: Vec<HitErrors>,
}

impl TracedKind {
    fn measure(race: &Race<'_>, prepared: &Prepared<'_>, kind: RayKind, rays: &RaySet) -> Self {
        let query = Query::of(kind);
        let passes = race.passes(prepared, query, rays);
        let tracer = Tracer::new(race.scene, race.stop);
        let seconds = ReferenceRun::new(&tracer, rays, query).pass(race.pool);
        (race.on_step)();
        let measure =
            |found: &Passes| race.pool.install(|| HitErrors::measure(&tracer, rays, query, &found.hits));
        let of_scalar = measure(&passes[0]);
        let of_same = |found: &Passes| found.hits.has_same_bits(&passes[0].hits).then_some(of_scalar);
        let errors = passes.iter().map(|found| of_same(found).unwrap_or_else(|| measure(found))).collect();
        (race.on_step)();
        let reference = Spread::of(vec![mrays_per_second(rays, seconds)], Better::More);
        Self { kind, reference, passes, errors }
    }
}

fn of_reference(seconds: f64, scalar: Option<Spread>, traced: &[TracedKind]) -> EngineResult {
    let frame_seconds = Spread::of(vec![seconds], Better::Less);
    EngineResult {
        engine: "reference",
        lanes: 1,
        frame_seconds,
        speed_up: speed_up(scalar, frame_seconds),
        mrays_per_second: traced.iter().map(|of| (of.kind, of.reference)).collect(),
        hits: BTreeMap::new(),
        image: Distance::ZERO,
        same_bits_as_scalar: None,
    }
}

fn of_wavefront(turn: usize, frames: &[Frames], truth: &Image, traced: &[TracedKind]) -> EngineResult {
    let (frame, scalar) = (&frames[turn], &frames[0]);
    let same_hits = traced.iter().all(|of| of.passes[turn].hits.has_same_bits(&of.passes[0].hits));
    EngineResult {
        engine: if Width::ALL[turn] == Width::One { "scalar" } else { "simd" },
        lanes: Width::ALL[turn].lanes(),
        frame_seconds: frame.trace_seconds,
        speed_up: speed_up(scalar.trace_seconds, frame.trace_seconds),
        mrays_per_second: traced.iter().map(|of| (of.kind, of.passes[turn].mrays_per_second)).collect(),
        hits: traced.iter().map(|of| (of.kind, of.errors[turn])).collect(),
        image: Distance::between(truth, &frame.last.image),
        same_bits_as_scalar: Some(same_hits && has_same_bits(&frame.last.image, &scalar.last.image)),
    }
}

fn floor(race: &Race<'_>) -> Result<Image, RenderError> {
    let tracer = Tracer::with_precision(race.scene, Precision::F32Queues, race.stop);
    let image = race.pool.install(|| agreement::picture(race.scene, &tracer))?;
    if race.stop.load(Ordering::Relaxed) { Err(RenderError::Stopped) } else { Ok(image) }
}
