//! Formulas for the test of a ray against a sphere.

use super::columns::{Columns, Lane};
use crate::kernel::sphere::{self, Line};
use crate::kernel::textbook::{compensated_sphere, quadratic};
use crate::lanes::{self, Single, Vector, Width};
use crate::reference::PairTruth;
use std::ops::Range;

/// Which formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    Quadratic,
    Engines,
    Compensated,
}

impl super::Formula for Formula {
    type Pairs = Columns<12>;

    const PRIMITIVE: &'static str = "sphere";
    const ALL: &'static [Self] = &[Self::Quadratic, Self::Engines, Self::Compensated];
    const ENGINES: Self = Self::Engines;

    fn name(self) -> &'static str {
        match self {
            Self::Quadratic => "naive",
            Self::Engines => "stable",
            Self::Compensated => "compensated",
        }
    }

    fn test(self, width: Width, pairs: &Columns<12>, tiles: Range<usize>, ts: &mut [f32]) {
        width.run(Test { formula: self, pairs, tiles, ts });
    }
}

impl super::WithTruth for Formula {
    fn truth(pairs: &Columns<12>, pair: usize) -> PairTruth {
        let [ox, oy, oz, dx, dy, dz, _, _, cx, cy, cz, radius] = pairs.row(pair);
        PairTruth::of_sphere([[ox, oy, oz], [dx, dy, dz]], [cx, cy, cz], radius)
    }
}

struct Test<'a> {
    formula: Formula,
    pairs: &'a Columns<12>,
    tiles: Range<usize>,
    ts: &'a mut [f32],
}

impl lanes::Job for Test<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let Self { formula, pairs, tiles, ts } = self;
        let zero = F::splat(0.0);
        match formula {
            Formula::Quadratic => pairs.test(tiles, ts, |lane| {
                let (line, center, radius) = load::<F>(lane);
                quadratic::nearest(&line, center, radius, zero)
            }),
            Formula::Engines => pairs.test(tiles, ts, |lane| {
                let (line, center, radius) = load::<F>(lane);
                sphere::meet(&line, center, radius * radius, zero).nearest(zero)
            }),
            Formula::Compensated => pairs.test(tiles, ts, |lane| {
                let (line, center, radius) = load::<F>(lane);
                compensated_sphere::nearest(&line, center, radius, zero)
            }),
        }
    }
}

#[inline(always)]
fn load<F: Single>(lane: &Lane<'_, 12>) -> (Line<F>, Vector<F>, F) {
    let line = Line {
        origin: Vector::new(lane.load(0), lane.load(1), lane.load(2)),
        origin_low: None,
        direction: Vector::new(lane.load(3), lane.load(4), lane.load(5)),
        a: lane.load(6),
        inverse_a: lane.load(7),
    };
    (line, Vector::new(lane.load(8), lane.load(9), lane.load(10)), lane.load(11))
}
