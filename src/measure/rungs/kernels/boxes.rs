//! Formulas for the test of a ray against a box, and the true hits that each would have the tree leave out.

use super::super::RungOptions;
use super::boxes_met::{BoxPair, BoxesMet};
use super::columns::{Columns, Lane, Tiles};
use super::{Formula as _, answers, race};
use crate::kernel::bounds::{self, Slabs};
use crate::kernel::textbook::slabs::{self, Multiplied};
use crate::lanes::{self, Single, Vector, Width};
use crate::measure::{Better, Spread};
use crate::prepare::Prepared;
use crate::render::RenderError;
use serde::Serialize;
use std::ops::Range;

/// Which formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    Multiplied,
    Unpadded,
    Engines,
}

impl super::Formula for Formula {
    type Pairs = Columns<21>;

    const PRIMITIVE: &'static str = "box";
    const ALL: &'static [Self] = &[Self::Multiplied, Self::Unpadded, Self::Engines];
    const ENGINES: Self = Self::Engines;

    fn name(self) -> &'static str {
        match self {
            Self::Multiplied => "multiplied out",
            Self::Unpadded => "not padded",
            Self::Engines => "padded",
        }
    }

    fn test(self, width: Width, pairs: &Columns<21>, tiles: Range<usize>, ts: &mut [f32]) {
        width.run(Test { formula: self, pairs, tiles, ts });
    }
}

struct Test<'a> {
    formula: Formula,
    pairs: &'a Columns<21>,
    tiles: Range<usize>,
    ts: &'a mut [f32],
}

impl lanes::Job for Test<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let Self { formula, pairs, tiles, ts } = self;
        let (zero, end) = (F::splat(0.0), F::splat(f32::MAX));
        let planes = |lane: &Lane<'_, 21>| [vector(lane, 0), vector(lane, 3)];
        match formula {
            Formula::Engines => pairs.test(tiles, ts, |lane| {
                let [near, far] = planes(lane);
                let [inverse, near_origin, far_origin] = [vector(lane, 6), vector(lane, 9), vector(lane, 12)];
                bounds::enter::<F>(&Slabs { near_origin, far_origin, inverse }, near, far, zero, end)
            }),
            Formula::Unpadded => pairs.test(tiles, ts, |lane| {
                let [near, far] = planes(lane);
                let [inverse, origin] = [vector(lane, 6), vector(lane, 15)];
                let slabs = Slabs { near_origin: origin, far_origin: origin, inverse };
                bounds::enter::<F>(&slabs, near, far, zero, end)
            }),
            Formula::Multiplied => pairs.test(tiles, ts, |lane| {
                let [near, far] = planes(lane);
                let ray = Multiplied { inverse: vector(lane, 6), origin_by_direction: vector(lane, 18) };
                slabs::enter::<F>(&ray, near, far, zero, end)
            }),
        }
    }
}

#[inline(always)]
fn vector<F: Single>(lane: &Lane<'_, 21>, first: usize) -> Vector<F> {
    Vector::new(lane.load(first), lane.load(first + 1), lane.load(first + 2))
}

/// What the planes of a box and a ray make of one pair.
pub(super) fn box_pair(
    slabs: &Slabs<f32>,
    origin: [f32; 3],
    backwards: [bool; 3],
    [low, high]: [[f32; 3]; 2],
) -> BoxPair {
    let mut row = [0.0; 21];
    let inverse = super::pairs::array(slabs.inverse);
    let (near_origin, far_origin) =
        (super::pairs::array(slabs.near_origin), super::pairs::array(slabs.far_origin));
    for axis in 0..3 {
        let (near, far) = if backwards[axis] { (high[axis], low[axis]) } else { (low[axis], high[axis]) };
        let numbers = [
            near,
            far,
            inverse[axis],
            near_origin[axis],
            far_origin[axis],
            origin[axis],
            origin[axis] * inverse[axis],
        ];
        for (place, number) in numbers.into_iter().enumerate() {
            row[3 * place + axis] = number;
        }
    }
    row
}

/// Formulas for the test of a box. A true hit is a pair of a ray and a primitive that it meets at a t > 0, in f64; it is left
/// out where the ray is found to miss the box of the leaf that the primitive is in.
#[derive(Clone, Debug, Serialize)]
pub struct BoxRung {
    /// Lanes of the kernels.
    pub lanes: u32,
    /// Pairs of ray and box that were played back for time: those that some of the rays test up to their hits.
    pub pairs: u64,
    /// True hits of some of the rays, wherever along them.
    pub true_hits: u64,
    /// Formula by formula.
    pub formulas: Vec<BoxRun>,
}

/// One formula.
#[derive(Clone, Debug, Serialize)]
pub struct BoxRun {
    /// Its name.
    pub name: &'static str,
    /// Whether the engine uses it.
    pub is_engines: bool,
    /// For all pairs once, on one thread; of the rounds. None where it was not timed.
    pub seconds: Option<Spread>,
    /// True hits left out.
    pub left_out: u64,
}

impl BoxRung {
    /// None where no ray tests a box.
    pub(super) fn of(met: &BoxesMet, options: &RungOptions<'_>) -> Result<Option<Self>, RenderError> {
        if met.tested.pairs() == 0 {
            return Ok(None);
        }
        let seconds = race::race::<Formula>(&met.tested, options)?;
        let mut this = Self::untimed(&met.of_true_hits, options.width);
        this.pairs = met.tested.pairs() as u64;
        for (run, seconds) in this.formulas.iter_mut().zip(seconds) {
            run.seconds = Spread::of(seconds, Better::Less);
        }
        Ok(Some(this))
    }

    /// Counts what is left out of the true hits of rays from the eye that are aimed where leaving a box and entering it fall
    /// together; none where there are no such hits.
    ///
    /// # Errors
    /// No threads to be had, or told to stop.
    pub fn at_corners(
        prepared: &Prepared<'_>,
        options: &RungOptions<'_>,
    ) -> Result<Option<Self>, RenderError> {
        options.step("aiming rays at corners of boxes", 0, 1)?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
        let rung = Self::untimed(&BoxesMet::at_corners(prepared, &pool).of_true_hits, options.width);
        Ok(Some(rung).filter(|rung| rung.true_hits > 0))
    }

    /// Counts what is left out of true hits.
    fn untimed(true_hits: &Columns<21>, width: Width) -> Self {
        let run = |&formula: &Formula| {
            let enters = answers(formula, width, true_hits);
            BoxRun {
                name: formula.name(),
                is_engines: formula == Formula::ENGINES,
                seconds: None,
                left_out: enters.iter().filter(|enters| enters.is_infinite()).count() as u64,
            }
        };
        Self {
            lanes: width.lanes(),
            pairs: 0,
            true_hits: true_hits.pairs() as u64,
            formulas: Formula::ALL.iter().map(run).collect(),
        }
    }

    /// Nanoseconds of one test by a formula: the median of the rounds.
    #[must_use]
    pub fn nanoseconds(&self, formula: &BoxRun) -> Option<f64> {
        Some(formula.seconds?.median * 1e9 / self.pairs as f64)
    }
}
