//! Formulas for the test of a ray against a triangle.

use super::columns::{Columns, Lane};
use crate::kernel::textbook::moller_trumbore;
use crate::kernel::{RaySpace, triangle};
use crate::lanes::{self, Single, Vector, Width};
use crate::reference::PairTruth;
use std::ops::Range;

/// Which formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    MollerTrumbore,
    Engines,
}

impl super::Formula for Formula {
    type Pairs = Columns<18>;

    const PRIMITIVE: &'static str = "triangle";
    const ALL: &'static [Self] = &[Self::MollerTrumbore, Self::Engines];
    const ENGINES: Self = Self::Engines;

    fn name(self) -> &'static str {
        match self {
            Self::MollerTrumbore => "Möller–Trumbore",
            Self::Engines => "watertight",
        }
    }

    fn test(self, width: Width, pairs: &Columns<18>, tiles: Range<usize>, ts: &mut [f32]) {
        width.run(Test { formula: self, pairs, tiles, ts });
    }
}

impl super::WithTruth for Formula {
    fn truth(pairs: &Columns<18>, pair: usize) -> PairTruth {
        let [ox, oy, oz, dx, dy, dz, _, _, _, ax, ay, az, bx, by, bz, cx, cy, cz] = pairs.row(pair);
        let vertices = [[ax, ay, az], [bx, by, bz], [cx, cy, cz]];
        PairTruth::of_triangle([[ox, oy, oz], [dx, dy, dz]], vertices)
    }
}

struct Test<'a> {
    formula: Formula,
    pairs: &'a Columns<18>,
    tiles: Range<usize>,
    ts: &'a mut [f32],
}

impl lanes::Job for Test<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let Self { formula, pairs, tiles, ts } = self;
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        match formula {
            Formula::MollerTrumbore => pairs.test(tiles, ts, |lane| {
                let origin = Vector::new(lane.load(0), lane.load(1), lane.load(2));
                let direction = Vector::new(lane.load(3), lane.load(4), lane.load(5));
                let [a, b, c] = vertices::<F>(lane);
                let corners = [vector(a), vector(b), vector(c)];
                moller_trumbore::nearest([origin, direction], corners, zero, one)
            }),
            Formula::Engines => pairs.test(tiles, ts, |lane| {
                let space = RaySpace {
                    origin: [lane.load(0), lane.load(1), lane.load(2)],
                    origin_low: None,
                    shear: [lane.load(6), lane.load(7)],
                    t_per_z: lane.load(8),
                };
                let meeting = triangle::meet(&space, vertices::<F>(lane));
                let t = meeting.t(&space);
                (t, meeting.inside(zero) & t.gt(zero))
            }),
        }
    }
}

#[inline(always)]
fn vertices<F: Single>(lane: &Lane<'_, 18>) -> [[F; 3]; 3] {
    [
        [lane.load(9), lane.load(10), lane.load(11)],
        [lane.load(12), lane.load(13), lane.load(14)],
        [lane.load(15), lane.load(16), lane.load(17)],
    ]
}

#[inline(always)]
fn vector<F: Single>([x, y, z]: [F; 3]) -> Vector<F> {
    Vector::new(x, y, z)
}
