//! The kernels' rungs: on pairs of ray and primitive that a frame really tests, what a formula costs and how wrong it is.
//!
//! Each formula gets the same pairs at the same width, and nothing around it: no traversal, and none of what the engine does
//! about a kernel's errors, which decides in f64 where f32 cannot tell (`traverse::candidate`, `traverse::exact`). So the
//! engine's picture is better than its kernels; what is seen here is how often it needs to be.
//!
//! - `columns`, `outlines`: numbers of pairs as lanes read them
//! - `pairs`, `boxes_met`: which pairs are tested
//! - `boxes`, `sphere`, `triangle`, `polygon`: the formulas
//! - `race`: formulas timed in turn
//! - `errors`: answers against the truth in f64, from the same f32 numbers
//! - `leaks`, `aimed`: rays aimed at what faces share

mod aimed;
mod boxes;
mod boxes_met;
mod columns;
mod errors;
mod leaks;
mod outlines;
mod pairs;
mod polygon;
mod race;
mod sphere;
mod triangle;

pub use boxes::{BoxRun, BoxRung};
pub use errors::PairErrors;
pub use leaks::{LeakRung, Leaks};

use super::RungOptions;
use crate::lanes::Width;
use crate::measure::{Better, Spread};
use crate::prepare::Prepared;
use crate::rays::{RayKind, RaySet};
use crate::reference::PairTruth;
use crate::render::RenderError;
use crate::trace::{Query, RayColumns, Run};
use boxes_met::BoxesMet;
use columns::{TILE, Tiles};
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
    /// Boxes; none where no ray tests any.
    pub boxes: Option<BoxRung>,
    /// Spheres; likewise.
    pub sphere: Option<KernelRung>,
    /// Triangles; likewise.
    pub triangle: Option<KernelRung>,
    /// Polygons; likewise.
    pub polygon: Option<KernelRung>,
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
    /// Edges of the polygons among these pairs; none for what has always as many.
    pub edges: Option<u64>,
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

/// A formula for pairs of ray and primitive.
trait Formula: Copy + Eq + 'static {
    type Pairs: Tiles;

    const PRIMITIVE: &'static str;
    const ALL: &'static [Self];
    /// The one that the engine uses.
    const ENGINES: Self;

    fn name(self) -> &'static str;
    /// Answers a run of tiles: a t for each place, infinite on a miss.
    fn test(self, width: Width, pairs: &Self::Pairs, tiles: Range<usize>, ts: &mut [f32]);
}

/// A formula for what has a right answer.
trait WithTruth: Formula {
    fn truth(pairs: &Self::Pairs, pair: usize) -> PairTruth;
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
        let columns = RayColumns::new(prepared, rays);
        let mut run = Run::new(prepared, &columns, Query::Closest);
        run.pass(options.width, &pool);
        let rays = (&columns, run.ends());

        let boxes = BoxRung::of(&BoxesMet::collect(prepared, rays, &pool), options)?;
        let Pairs { spheres, triangles, polygons } = Pairs::collect(prepared, rays, &pool, MOST_PAIRS);
        let polygon = rung::<polygon::Formula>(&polygons, options, &pool)?;
        let edges = polygons.columns.edges();
        Ok(Self {
            rays: kind,
            boxes,
            sphere: rung::<sphere::Formula>(&spheres, options, &pool)?,
            triangle: rung::<triangle::Formula>(&triangles, options, &pool)?,
            polygon: polygon.map(|rung| KernelRung { edges: Some(edges), ..rung }),
        })
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.boxes.is_none() && self.primitives().next().is_none()
    }

    /// Those of spheres, triangles and polygons that there are.
    pub fn primitives(&self) -> impl Iterator<Item = &KernelRung> {
        [&self.sphere, &self.triangle, &self.polygon].into_iter().flatten()
    }
}

fn rung<F: WithTruth>(
    sample: &Sample<F::Pairs>,
    options: &RungOptions<'_>,
    pool: &rayon::ThreadPool,
) -> Result<Option<KernelRung>, RenderError> {
    let pairs = &sample.columns;
    if pairs.pairs() == 0 {
        return Ok(None);
    }
    let seconds = race::race::<F>(pairs, options)?;
    let truths: Vec<PairTruth> =
        pool.install(|| (0..pairs.pairs()).into_par_iter().map(|pair| F::truth(pairs, pair)).collect());
    let formulas = F::ALL.iter().zip(seconds).map(|(&formula, seconds)| FormulaRun {
        name: formula.name(),
        is_engines: formula == F::ENGINES,
        seconds: Spread::of(seconds, Better::Less),
        errors: PairErrors::of(&truths, &answers(formula, options.width, pairs)),
    });
    Ok(Some(KernelRung {
        primitive: F::PRIMITIVE,
        lanes: options.width.lanes(),
        tested: sample.tested,
        pairs: pairs.pairs() as u64,
        edges: None,
        formulas: formulas.collect(),
    }))
}

/// A t for each pair, infinite on a miss.
fn answers<F: Formula>(formula: F, width: Width, pairs: &F::Pairs) -> Vec<f32> {
    let mut ts = vec![0.0; pairs.tiles() * TILE];
    formula.test(width, pairs, 0..pairs.tiles(), &mut ts);
    (0..pairs.pairs()).map(|pair| ts[pairs.place(pair)]).collect()
}

impl KernelRung {
    /// Nanoseconds of one test by a formula: the median of the rounds, and its median absolute deviation.
    #[must_use]
    pub fn nanoseconds(&self, formula: &FormulaRun) -> Option<[f64; 2]> {
        let Spread { median, median_absolute_deviation, .. } = formula.seconds?;
        Some([median, median_absolute_deviation].map(|seconds| seconds * 1e9 / self.pairs as f64))
    }
}
