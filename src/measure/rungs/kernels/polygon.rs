//! Formulas for the test of a ray against a polygon.

use super::outlines::{Lane, Outlines};
use crate::kernel::polygon::{self, Outline};
use crate::kernel::sphere::Line;
use crate::kernel::textbook::axis_polygon;
use crate::kernel::{RaySpace, axes_from};
use crate::lanes::{self, Mask, Single, Vector, Width};
use crate::reference::PairTruth;
use std::ops::Range;

/// Which formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    AlongAxis,
    Engines,
}

impl super::Formula for Formula {
    type Pairs = Outlines;

    const PRIMITIVE: &'static str = "polygon";
    const ALL: &'static [Self] = &[Self::AlongAxis, Self::Engines];
    const ENGINES: Self = Self::Engines;

    fn name(self) -> &'static str {
        match self {
            Self::AlongAxis => "along an axis",
            Self::Engines => "along the ray",
        }
    }

    fn test(self, width: Width, pairs: &Outlines, tiles: Range<usize>, ts: &mut [f32]) {
        width.run(Test { formula: self, pairs, tiles, ts });
    }
}

impl super::WithTruth for Formula {
    fn truth(pairs: &Outlines, pair: usize) -> PairTruth {
        let ([ox, oy, oz, dx, dy, dz, ..], corners) = pairs.row(pair);
        PairTruth::of_polygon([[ox, oy, oz], [dx, dy, dz]], &corners)
    }
}

struct Test<'a> {
    formula: Formula,
    pairs: &'a Outlines,
    tiles: Range<usize>,
    ts: &'a mut [f32],
}

impl lanes::Job for Test<'_> {
    type Output = ();

    fn run<F: Single>(self) {
        let Self { formula, pairs, tiles, ts } = self;
        match formula {
            Formula::AlongAxis => pairs.test(tiles, ts, along_axis::<F>),
            Formula::Engines => pairs.test(tiles, ts, engines::<F>),
        }
    }
}

/// As `traverse` tests a polygon with a packet of rays.
#[inline(always)]
fn engines<F: Single>(lane: &Lane<'_>) -> (F, F::Mask) {
    let zero = F::splat(0.0);
    let [x, y, z] = axes_from(lane.shape().third);
    let space = RaySpace {
        origin: [lane.load(x), lane.load(y), lane.load(z)],
        origin_low: None,
        shear: [lane.load(6), lane.load(7)],
        t_per_z: lane.load(8),
    };
    let mut outline = Outline::<F>::new();
    let see = |corner| {
        space.see([lane.coordinate(corner, x), lane.coordinate(corner, y), lane.coordinate(corner, z)])
    };
    if let Some(last) = lane.corners.last() {
        let mut from = see(last);
        for corner in lane.corners {
            let to = see(corner);
            outline.add_edge(&from, &to, zero);
            from = to;
        }
    }
    let corner_ts = [outline.least_z * space.t_per_z, outline.largest_z * space.t_per_z];
    let [origin, direction] = line(lane);
    // Of a line the plane takes no more than these.
    let line = Line { origin, origin_low: None, direction, a: zero, inverse_a: zero };
    let meeting = polygon::meet_plane(&line, plane(lane), corner_ts, zero);
    (meeting.t, outline.odd & meeting.meets & meeting.t.gt(zero))
}

#[inline(always)]
fn along_axis<F: Single>(lane: &Lane<'_>) -> (F, F::Mask) {
    let [u, v, _] = axes_from(lane.shape().steepest);
    let kept = [[lane.load(u), lane.load(v)], [lane.load(3 + u), lane.load(3 + v)]];
    let foot = axis_polygon::meet_plane(line(lane), plane(lane), kept);
    let mut inside = F::Mask::NONE;
    if let Some(last) = lane.corners.last() {
        let mut from = [lane.coordinate(last, u), lane.coordinate(last, v)];
        for corner in lane.corners {
            let to = [lane.coordinate(corner, u), lane.coordinate(corner, v)];
            inside = inside.xor(axis_polygon::crosses(foot.kept, from, to));
            from = to;
        }
    }
    (foot.t, inside & foot.t.gt(F::splat(0.0)))
}

/// Origin and direction.
#[inline(always)]
fn line<F: Single>(lane: &Lane<'_>) -> [Vector<F>; 2] {
    [
        Vector::new(lane.load(0), lane.load(1), lane.load(2)),
        Vector::new(lane.load(3), lane.load(4), lane.load(5)),
    ]
}

/// A point and the normal.
#[inline(always)]
fn plane<F: Single>(lane: &Lane<'_>) -> [Vector<F>; 2] {
    [
        Vector::new(lane.load(9), lane.load(10), lane.load(11)),
        Vector::new(lane.load(12), lane.load(13), lane.load(14)),
    ]
}
