//! What an engine does to rays, counted.

use super::aims::{Aim, Shot};
use super::body::Body;
use super::every_face::{is_nearest, met};
use super::tally::Tally;
use super::tracing::{Engine, Met, Target, ray_set};
use wavelane::trace::Hits;

/// An engine before a body.
pub(super) struct Judge<'a> {
    pub(super) body: &'a Body,
    /// The body's kind, for the tally.
    pub(super) kind: usize,
    pub(super) engine: Engine,
    pub(super) target: Target<'a>,
    pub(super) pool: &'a rayon::ThreadPool,
    pub(super) tally: Tally,
}

/// A ray that is tried against every face.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) aim: Aim,
    pub(super) shot: Shot,
    pub(super) is_from_inside: bool,
}

impl Judge<'_> {
    /// From inside.
    pub(super) fn all_are_caught(&mut self, aim: Aim, shots: &[Shot]) {
        let traced = self.target.trace(&ray_set(shots));
        let cell = self.tally.cell(self.kind, aim);
        cell.rays += shots.len() as u64;
        cell.in_packets += traced.in_packets;
        for (row, shot) in shots.iter().enumerate() {
            let found = traced.found(row);
            if found.id == Hits::MISS {
                self.tally.cell(self.kind, aim).leaks += 1;
                self.report("leak", shot, found, &[]);
            }
            if !traced.is_occluded[row] {
                self.tally.cell(self.kind, aim).not_occluded += 1;
                self.report("not occluded", shot, found, &[]);
            }
        }
    }

    /// Rays meet the surface an odd number of times from inside and an even number from outside, and the hierarchy finds the
    /// nearest.
    pub(super) fn each_is_counted(&mut self, samples: &[Sample]) {
        let shots: Vec<Shot> = samples.iter().map(|sample| sample.shot).collect();
        let traced = self.target.trace(&ray_set(&shots));
        let all = met(self.body, &shots, self.engine, self.pool);
        for (row, (sample, met)) in samples.iter().zip(&all).enumerate() {
            let (shot, found) = (&sample.shot, traced.found(row));
            let is_double = shot.is_star && met.len() > 1;
            let has_wrong_parity = (met.len() % 2 == 1) != sample.is_from_inside;
            let is_lost = !is_nearest(self.body, shot, (found, met), self.engine, self.pool)
                || traced.is_occluded[row] == met.is_empty();
            let cell = self.tally.cell(self.kind, sample.aim);
            cell.counted += 1;
            cell.star += u64::from(shot.is_star);
            cell.doubles += u64::from(is_double);
            cell.wrong_parity += u64::from(has_wrong_parity);
            cell.lost += u64::from(is_lost);
            let failures =
                [(is_double, "more than once"), (has_wrong_parity, "wrong parity"), (is_lost, "lost")];
            for (_, what) in failures.into_iter().filter(|(is_so, _)| *is_so) {
                self.report(what, shot, found, met);
            }
        }
    }

    fn report(&mut self, what: &'static str, shot: &Shot, found: Met, met: &[Met]) {
        let Self { body, engine, .. } = self;
        self.tally.add_example(what, || {
            format!("{:?} finds {found:?}, {engine:?}; each face alone: {met:?}; {}", shot.row, body.name)
        });
    }
}
