//! Engines race in turns, so that what else the machine does falls on all of them alike.

use super::{Better, Spread};
use crate::film::{Image, Region};
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::rays::{RayCounts, RayKind, RaySet, RecordedRays};
use crate::render::{DEFAULT_BATCH, Engine, RenderError, RenderOptions, Rendered, render};
use crate::scene::Scene;
use crate::trace::{Hits, Query, RayColumns, Run};
use std::num::NonZeroU64;
use std::sync::atomic::AtomicBool;

/// The wavefront engine against itself, on one scene at several widths.
pub(super) struct Race<'a> {
    pub(super) scene: &'a Scene,
    pub(super) widths: &'a [Width],
    /// Timed rounds, at least 1; one more goes before them.
    pub(super) repeat: usize,
    pub(super) pool: &'a rayon::ThreadPool,
    pub(super) stop: &'a AtomicBool,
    /// Called after each frame and each pass.
    pub(super) on_step: &'a dyn Fn(),
}

/// Rays that are recorded at once, unless many more are asked for: some 250 MB of them.
const MOST_HELD: u64 = 1 << 22;

/// Frames of one width.
pub(super) struct Frames {
    pub(super) trace_seconds: Option<Spread>,
    pub(super) prepare_seconds: Vec<f64>,
    pub(super) last: Rendered,
}

/// Passes of one width over rays of one kind.
pub(super) struct Passes {
    pub(super) mrays_per_second: Option<Spread>,
    pub(super) hits: Hits,
}

impl Race<'_> {
    /// How often [`Self::on_step`] is called by [`Self::frames`], and by each [`Self::passes`].
    pub(super) fn steps(widths: usize, repeat: usize) -> u64 {
        widths as u64 * (repeat as u64 + 1)
    }

    /// The whole picture, on as many threads as the pool has.
    pub(super) fn render(&self, engine: Engine) -> Result<Rendered, RenderError> {
        let options = RenderOptions {
            engine,
            region: Region::whole(self.scene.image.width, self.scene.image.height),
            threads: self.pool.current_num_threads(),
            on_progress: &|_| {},
            stop: self.stop,
        };
        render(self.scene, &options)
    }

    /// Frames of each width.
    pub(super) fn frames(&self) -> Result<Vec<Frames>, RenderError> {
        let mut trace_seconds = vec![Vec::new(); self.widths.len()];
        let mut prepare_seconds = trace_seconds.clone();
        let mut last = Vec::new();
        for round in 0..=self.repeat {
            last.clear();
            for (turn, &width) in self.widths.iter().enumerate() {
                let rendered = self.render(Engine::wavefront(width))?;
                if round > 0 {
                    trace_seconds[turn].push(rendered.trace_seconds);
                    prepare_seconds[turn].push(rendered.prepare_seconds);
                }
                last.push(rendered);
                (self.on_step)();
            }
        }
        let frames = last.into_iter().zip(trace_seconds).zip(prepare_seconds);
        Ok(frames
            .map(|((last, trace_seconds), prepare_seconds)| Frames {
                trace_seconds: Spread::of(trace_seconds, Better::Less),
                prepare_seconds,
                last,
            })
            .collect())
    }

    /// About as many rays of each kind as asked for, from all over the frame, or all of a kind that has fewer.
    ///
    /// Of a frame of very many rays, they are those of every n-th tile; of more tiles where a kind would be left out.
    pub(super) fn record(&self, frame: RayCounts, most: u64) -> Result<RecordedRays, RenderError> {
        let held = MOST_HELD.max(most.saturating_mul(4));
        let mut every = NonZeroU64::new(frame.total().div_ceil(held)).unwrap_or(NonZeroU64::MIN);
        loop {
            let rays = Some(every);
            let engine = Engine::Wavefront { width: Width::BEST, batch: DEFAULT_BATCH, records: false, rays };
            let recorded = self.render(engine)?.recorded;
            let is_missed = |kind| frame.of(kind) > 0 && recorded.of(kind).is_empty();
            if every == NonZeroU64::MIN || !RayKind::ALL.into_iter().any(is_missed) {
                return Ok(recorded.thinned(usize::try_from(most).unwrap_or(usize::MAX)));
            }
            every = NonZeroU64::new(every.get() / 8).unwrap_or(NonZeroU64::MIN);
        }
    }

    /// Passes of each width over rays.
    pub(super) fn passes(&self, prepared: &Prepared<'_>, query: Query, rays: &RaySet) -> Vec<Passes> {
        let columns = RayColumns::new(prepared, rays);
        let mut run = Run::new(prepared, &columns, query);
        let mut rates = vec![Vec::new(); self.widths.len()];
        let mut hits = Vec::new();
        for round in 0..=self.repeat {
            hits.clear();
            for (turn, &width) in self.widths.iter().enumerate() {
                let seconds = run.pass(width, self.pool);
                if round > 0 {
                    rates[turn].push(mrays_per_second(rays, seconds));
                }
                hits.push(run.hits());
                (self.on_step)();
            }
        }
        let passes = hits.into_iter().zip(rates);
        passes
            .map(|(hits, rates)| Passes { mrays_per_second: Spread::of(rates, Better::More), hits })
            .collect()
    }
}

pub(super) fn mrays_per_second(rays: &RaySet, seconds: f64) -> f64 {
    rays.len() as f64 / seconds / 1e6
}

/// How many times faster what took `seconds` is than what took `of`: medians.
pub(super) fn speed_up(of: Option<Spread>, seconds: Option<Spread>) -> Option<f64> {
    let (of, seconds) = (of?.median, seconds?.median);
    (seconds > 0.0).then(|| of / seconds)
}

/// Whether two pictures of one size are the same, to the bit.
pub(super) fn has_same_bits(a: &Image, b: &Image) -> bool {
    bytemuck::cast_slice::<_, u32>(&a.pixels) == bytemuck::cast_slice::<_, u32>(&b.pixels)
}
