//! The kernels' rungs: on pairs of ray and primitive that a frame really tests, what a formula costs and how wrong it is.
//!
//! Each formula gets the same pairs at the same width, and nothing around it: no traversal, and none of what the engine does
//! about a kernel's errors, which decides in f64 where f32 cannot tell (`traverse::candidate`, `traverse::exact`). So the
//! engine's picture is better than its kernels; what is seen here is how often it needs to be.
//!
//! - `columns`: numbers of pairs as lanes read them
//! - `pairs`: which pairs are tested
//! - `sphere`, `triangle`: the formulas
//! - `race`: formulas timed in turn
//! - `errors`: answers against the truth in f64, from the same f32 numbers
//! - `leaks`, `aimed`: rays aimed at what triangles share

mod aimed;
mod columns;
mod errors;
mod leaks;
mod pairs;
mod race;
mod sphere;
mod triangle;

pub use errors::PairErrors;
pub use leaks::{LeakRung, Leaks};

use super::RungOptions;
use crate::lanes::Width;
use crate::measure::{Better, Spread};
use crate::prepare::Prepared;
use crate::rays::{RayKind, RaySet};
use crate::reference::PairTruth;
use crate::render::RenderError;
use columns::{Columns, TILE};
use pairs::{Pairs, Sample};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// Pairs of a kind of primitive are sampled down to as many.
pub const MOST_PAIRS: u64 = 1 << 20;

/// The kernels' rungs for the rays of one kind.
#[derive(Clone, Debug, Serialize)]
pub struct KernelRungs {
    /// Whose pairs were tested.
    pub rays: RayKind,
    /// Spheres; none where no ray tests any.
    pub sphere: Option<KernelRung>,
    /// Triangles; likewise.
    pub triangle: Option<KernelRung>,
}

/// Formulas for the test of one kind of primitive.
#[derive(Clone, Debug, Serialize)]
pub struct KernelRung {
    /// What is tested.
    pub primitive: &'static str,
    /// Lanes of the kernels.
    pub lanes: u32,
    /// Pairs of ray and primitive that the rays' walks through the hierarchy test.
    pub tested: u64,
    /// Pairs that were played back, evenly taken from them.
    pub pairs: u64,
    /// Formula by formula.
    pub formulas: Vec<FormulaRun>,
}

/// One formula.
#[derive(Clone, Debug, Serialize)]
pub struct FormulaRun {
    /// Its name.
    pub name: &'static str,
    /// Whether the engine uses it.
    pub is_engines: bool,
    /// For all pairs once, on one thread; of the rounds.
    pub seconds: Option<Spread>,
    /// Against the truth.
    pub errors: PairErrors,
}

/// A formula for pairs of N numbers.
trait Formula<const N: usize>: Copy + Eq + 'static {
    const PRIMITIVE: &'static str;
    const ALL: &'static [Self];
    /// The one that the engine uses.
    const ENGINES: Self;

    fn name(self) -> &'static str;
    /// Answers a run of tiles: a t for each row, infinite on a miss.
    fn test(self, width: Width, pairs: &Columns<N>, tiles: Range<usize>, ts: &mut [f32]);
    /// The right answer.
    fn truth(pair: [f32; N]) -> PairTruth;
}

impl KernelRungs {
    /// Plays the rays of a frame back through the kernels.
    ///
    /// # Errors
    /// No threads to be had, or told to stop.
    pub fn measure(
        prepared: &Prepared<'_>,
        kind: RayKind,
        rays: &RaySet,
        options: &RungOptions<'_>,
    ) -> Result<Self, RenderError> {
        options.step("collecting pairs of rays and primitives", 0, 1)?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
        let Pairs { spheres, triangles } = Pairs::collect(prepared, rays, options.width, &pool, MOST_PAIRS);
        Ok(Self {
            rays: kind,
            sphere: rung::<sphere::Formula, _>(&spheres, options, &pool)?,
            triangle: rung::<triangle::Formula, _>(&triangles, options, &pool)?,
        })
    }
}

fn rung<F: Formula<N>, const N: usize>(
    sample: &Sample<N>,
    options: &RungOptions<'_>,
    pool: &rayon::ThreadPool,
) -> Result<Option<KernelRung>, RenderError> {
    let pairs = &sample.columns;
    if pairs.len() == 0 {
        return Ok(None);
    }
    let seconds = race::race::<F, N>(pairs, options)?;
    let truths: Vec<PairTruth> =
        pool.install(|| (0..pairs.len()).into_par_iter().map(|row| F::truth(pairs.row(row))).collect());
    let formulas = F::ALL.iter().zip(seconds).map(|(&formula, seconds)| {
        let ts = answers(formula, options.width, pairs);
        FormulaRun {
            name: formula.name(),
            is_engines: formula == F::ENGINES,
            seconds: Spread::of(seconds, Better::Less),
            errors: PairErrors::of(&truths, &ts),
        }
    });
    Ok(Some(KernelRung {
        primitive: F::PRIMITIVE,
        lanes: options.width.lanes(),
        tested: sample.tested,
        pairs: pairs.len() as u64,
        formulas: formulas.collect(),
    }))
}

/// A t for each pair, infinite on a miss; and some more, of what fills the last tile.
fn answers<F: Formula<N>, const N: usize>(formula: F, width: Width, pairs: &Columns<N>) -> Vec<f32> {
    let mut ts = vec![0.0; pairs.tiles() * TILE];
    formula.test(width, pairs, 0..pairs.tiles(), &mut ts);
    ts
}

impl KernelRung {
    /// Nanoseconds of one test by a formula: the median of the rounds, and its median absolute deviation.
    #[must_use]
    pub fn nanoseconds(&self, formula: &FormulaRun) -> Option<[f64; 2]> {
        let Spread { median, median_absolute_deviation, .. } = formula.seconds?;
        Some([median, median_absolute_deviation].map(|seconds| seconds * 1e9 / self.pairs as f64))
    }
}
