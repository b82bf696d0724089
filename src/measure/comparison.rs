//! Speed against error: every engine on one scene, the f64 reference being the truth.

use super::agreement::Distance;
use super::{Better, HitErrors, Spread};
use crate::film::{Image, Region};
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::rays::{RayCounts, RayKind, RaySet, RecordedRays};
use crate::reference::{Precision, Tracer};
use crate::render::{DEFAULT_BATCH, Engine, RenderError, RenderOptions, Rendered, render};
use crate::scene::Scene;
use crate::trace::{Hits, Query, RayColumns, ReferenceRun, Run};
use serde::Serialize;
use std::collections::BTreeMap;
use std::num::NonZeroU64;
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
        let mut contest = Contest::new(scene, options)?;
        let truth = contest.render(Engine::Reference)?;
        let frames = contest.frames()?;
        let recorded = contest.record(frames[0].rays)?;
        let prepared = contest.pool.install(|| Prepared::new(scene))?;
        let by_kind: Vec<KindResult> = RayKind::ALL
            .into_iter()
            .filter(|&kind| !recorded.of(kind).is_empty())
            .map(|kind| contest.kind(&prepared, kind, recorded.of(kind)))
            .collect();
        let floor = contest.floor()?;

        let truth_seconds = Spread::of(vec![truth.trace_seconds], Better::Less);
        let reference = EngineResult {
            engine: "reference",
            lanes: 1,
            frame_seconds: truth_seconds,
            speed_up: ratio(frames[0].seconds, truth_seconds),
            mrays_per_second: by_kind.iter().map(|of| (of.kind, of.reference)).collect(),
            hits: BTreeMap::new(),
            image: Distance::ZERO,
            same_bits_as_scalar: None,
        };
        let wavefront = Width::ALL.into_iter().zip(&frames).enumerate().map(|(index, (width, frame))| {
            let same_hits = by_kind.iter().all(|of| of.engines[index].same_bits);
            EngineResult {
                engine: if width == Width::One { "scalar" } else { "simd" },
                lanes: width.lanes(),
                frame_seconds: frame.seconds,
                speed_up: ratio(frames[0].seconds, frame.seconds),
                mrays_per_second: by_kind
                    .iter()
                    .map(|of| (of.kind, of.engines[index].mrays_per_second))
                    .collect(),
                hits: by_kind.iter().map(|of| (of.kind, of.engines[index].errors)).collect(),
                image: Distance::between(&truth.image, &frame.image),
                same_bits_as_scalar: Some(same_hits && has_same_bits(&frame.image, &frames[0].image)),
            }
        });
        let comparison = Self {
            pixels: truth.image.pixels.len() as u64,
            frame_rays: frames[0].rays,
            recorded_rays: recorded.counts(),
            threads: contest.pool.current_num_threads(),
            build_seconds: Spread::of(std::mem::take(&mut contest.build_seconds), Better::Less),
            engines: std::iter::once(reference).chain(wavefront).collect(),
            floor: Distance::between(&truth.image, &floor),
        };
        let engine = frames.into_iter().last().map_or_else(|| floor.clone(), |frame| frame.image);
        Ok((comparison, ComparedImages { truth: truth.image, floor, engine }))
    }

    /// Rays whose answer is wrong, though no rounding explains it: of any engine.
    #[must_use]
    pub fn mistakes(&self) -> u64 {
        self.engines.iter().flat_map(|engine| engine.hits.values()).map(HitErrors::mistakes).sum()
    }
}

/// The frames of an engine.
struct Frames {
    seconds: Option<Spread>,
    image: Image,
    rays: RayCounts,
}

/// A kind of ray, traced by every engine.
struct KindResult {
    kind: RayKind,
    /// Mrays/s.
    reference: Option<Spread>,
    /// In order of width.
    engines: Vec<KindOfEngine>,
}

struct KindOfEngine {
    mrays_per_second: Option<Spread>,
    errors: HitErrors,
    same_bits: bool,
}

/// A comparison that is under way.
struct Contest<'a> {
    scene: &'a Scene,
    options: &'a ComparisonOptions<'a>,
    pool: rayon::ThreadPool,
    build_seconds: Vec<f64>,
    steps: u64,
    steps_done: u64,
}

impl<'a> Contest<'a> {
    fn new(scene: &'a Scene, options: &'a ComparisonOptions<'a>) -> Result<Self, RenderError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
        let rounds = options.repeat as u64 + 1;
        let engines = Width::ALL.len() as u64;
        // Frames; of each kind of ray, passes, the reference's and the errors; the truth, the floor and the recording.
        let kinds = RayKind::ALL.len() as u64;
        let steps = rounds * engines + kinds * (rounds * engines + 2) + 3;
        Ok(Self { scene, options, pool, build_seconds: Vec::new(), steps, steps_done: 0 })
    }

    fn step(&mut self) {
        self.steps_done += 1;
        (self.options.on_progress)(self.steps_done, self.steps);
    }

    fn render(&mut self, engine: Engine) -> Result<Rendered, RenderError> {
        let options = RenderOptions {
            engine,
            region: Region::whole(self.scene.image.width, self.scene.image.height),
            threads: self.options.threads,
            on_progress: &|_| {},
            stop: self.options.stop,
        };
        let rendered = render(self.scene, &options)?;
        self.step();
        Ok(rendered)
    }

    /// Frames of every width, in turns, so that what else the machine does falls on all alike.
    fn frames(&mut self) -> Result<Vec<Frames>, RenderError> {
        let mut seconds = vec![Vec::new(); Width::ALL.len()];
        let mut last = Vec::new();
        for round in 0..=self.options.repeat {
            last.clear();
            for (width, seconds) in Width::ALL.into_iter().zip(&mut seconds) {
                let rendered = self.render(Engine::wavefront(width))?;
                if round > 0 {
                    seconds.push(rendered.trace_seconds);
                    self.build_seconds.push(rendered.prepare_seconds);
                }
                last.push((rendered.image, rendered.rays));
            }
        }
        let frames = last.into_iter().zip(seconds);
        Ok(frames
            .map(|((image, rays), seconds)| Frames {
                seconds: Spread::of(seconds, Better::Less),
                image,
                rays,
            })
            .collect())
    }

    /// Rays of every n-th tile, so that there are not many more of a kind than asked for.
    fn record(&mut self, frame: RayCounts) -> Result<RecordedRays, RenderError> {
        let most = RayKind::ALL.map(|kind| frame.of(kind)).into_iter().fold(0, u64::max);
        let every = NonZeroU64::new(most.div_ceil(self.options.rays.max(1))).unwrap_or(NonZeroU64::MIN);
        let engine =
            Engine::Wavefront { width: Width::BEST, batch: DEFAULT_BATCH, records: false, rays: Some(every) };
        Ok(self.render(engine)?.recorded)
    }

    fn kind(&mut self, prepared: &Prepared<'_>, kind: RayKind, rays: &RaySet) -> KindResult {
        let query = Query::of(kind);
        let mrays = |seconds: f64| rays.len() as f64 / seconds / 1e6;
        let columns = RayColumns::new(prepared, rays);
        let mut run = Run::new(prepared, &columns, query);
        let mut rates = vec![Vec::new(); Width::ALL.len()];
        let mut hits: Vec<Hits> = Vec::new();
        for round in 0..=self.options.repeat {
            hits.clear();
            for (width, rates) in Width::ALL.into_iter().zip(&mut rates) {
                let seconds = run.pass(width, &self.pool);
                if round > 0 {
                    rates.push(mrays(seconds));
                }
                hits.push(run.hits());
                self.step();
            }
        }
        let tracer = Tracer::new(self.scene, self.options.stop);
        let seconds = ReferenceRun::new(&tracer, rays, query).pass(&self.pool);
        self.step();
        let of_scalar = self.pool.install(|| HitErrors::measure(&tracer, rays, query, &hits[0]));
        self.step();
        let engines = rates.into_iter().zip(&hits).map(|(rates, found)| {
            let same_bits = found.has_same_bits(&hits[0]);
            let errors = match same_bits {
                true => of_scalar,
                false => self.pool.install(|| HitErrors::measure(&tracer, rays, query, found)),
            };
            KindOfEngine { mrays_per_second: Spread::of(rates, Better::More), errors, same_bits }
        });
        KindResult {
            kind,
            engines: engines.collect(),
            reference: Spread::of(vec![mrays(seconds)], Better::More),
        }
    }

    fn floor(&mut self) -> Result<Image, RenderError> {
        let tracer = Tracer::with_precision(self.scene, Precision::F32Queues, self.options.stop);
        let image = self.pool.install(|| super::agreement::picture(self.scene, &tracer))?;
        if self.options.stop.load(Ordering::Relaxed) {
            return Err(RenderError::Stopped);
        }
        self.step();
        Ok(image)
    }
}

/// How many times faster what took `seconds` is than what took `of`.
fn ratio(of: Option<Spread>, seconds: Option<Spread>) -> Option<f64> {
    let (of, seconds) = (of?.median, seconds?.median);
    (seconds > 0.0).then(|| of / seconds)
}

fn has_same_bits(a: &Image, b: &Image) -> bool {
    let bits =
        |image: &Image| image.pixels.iter().flatten().map(|channel| channel.to_bits()).collect::<Vec<_>>();
    bits(a) == bits(b)
}
