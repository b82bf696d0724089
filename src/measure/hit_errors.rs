//! What an engine found for recorded rays, against the truth.

use crate::rays::{Found, RaySet};
use crate::reference::{Met, Tracer};
use crate::scene::PrimitiveId;
use crate::trace::{Hits, Query};
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt::{self, Display, Formatter};

/// How wrong answers about rays are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct HitErrors {
    /// Rays that were compared; what is no ray is left out.
    pub rays: u64,
    /// Of them, those that hit in truth or, for shadow rays, are occluded.
    pub hits: u64,
    /// Rays that hit, though in truth they miss.
    pub false_hits: Wrong,
    /// Rays that miss, though in truth they hit.
    pub false_misses: Wrong,
    /// Rays that hit another primitive than in truth.
    pub other_primitives: Wrong,
    /// Of t, where the primitive is the true one, in units in the last place of the true t as f32; none without such rays.
    pub t_ulps: Option<Percentiles>,
    /// Of t, in what rounding the primitive's place to f32 once would do to it: see [`Met::t_per_rounding`].
    pub t_backward: Option<Percentiles>,
    /// Of the shading normal, as the distance between unit vectors, in 2⁻²⁴; none where normals are not known.
    pub normal: Option<Percentiles>,
}

/// Rays whose answer is not that of the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wrong {
    /// Within what rounding to f32 explains: an edge or a limb, or two surfaces, so near that no answer is wrong.
    pub near_edges: u64,
    /// Beyond that: mistakes.
    pub certain: u64,
}

/// The middle, the 99th percentile and the largest of many numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Percentiles {
    /// Half are no larger.
    pub p50: f64,
    /// 99 of 100 are no larger.
    pub p99: f64,
    /// None is larger.
    pub max: f64,
}

/// One ray's part.
#[derive(Default)]
struct Tally {
    errors: HitErrors,
    t_ulps: Vec<f64>,
    t_backward: Vec<f64>,
    normal: Vec<f64>,
}

impl HitErrors {
    /// Compares hits with what the reference finds for the same rays.
    #[must_use]
    pub fn measure(tracer: &Tracer<'_>, rays: &RaySet, query: Query, hits: &Hits) -> Self {
        Self::measure_every(1, tracer, rays, query, hits)
    }

    /// The same for the first of every n rays.
    #[must_use]
    pub fn measure_every(
        every: usize,
        tracer: &Tracer<'_>,
        rays: &RaySet,
        query: Query,
        hits: &Hits,
    ) -> Self {
        let rows = (0..rays.len()).into_par_iter().step_by(every.max(1));
        let tally = rows.fold(Tally::default, |mut tally, row| {
            match query {
                Query::Closest => tally.closest(tracer, rays, row, hits),
                Query::Any => tally.any(tracer, rays, row, hits),
            }
            tally
        });
        let mut tally = tally.reduce(Tally::default, Tally::with);
        Self {
            t_ulps: Percentiles::of(&mut tally.t_ulps),
            t_backward: Percentiles::of(&mut tally.t_backward),
            normal: Percentiles::of(&mut tally.normal),
            ..tally.errors
        }
    }

    /// Rays whose answer is wrong, though no rounding explains it.
    #[must_use]
    pub fn mistakes(&self) -> u64 {
        self.false_hits.certain + self.false_misses.certain + self.other_primitives.certain
    }

    /// Rays whose answer is not that of the truth, within what rounding explains.
    #[must_use]
    pub fn near_edges(&self) -> u64 {
        self.false_hits.near_edges + self.false_misses.near_edges + self.other_primitives.near_edges
    }
}

impl Display for HitErrors {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { false_hits, false_misses, other_primitives, .. } = self;
        write!(
            f,
            "{false_hits} false hits, {false_misses} false misses, {other_primitives} other primitives"
        )?;
        if let Some(t) = &self.t_ulps {
            write!(f, "; t off by {t} ulp")?;
        }
        if let Some(t) = &self.t_backward {
            write!(f, ", backward error {t} roundings")?;
        }
        Ok(())
    }
}

impl Display for Wrong {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.certain)?;
        match self.near_edges {
            0 => Ok(()),
            near => write!(f, " (and {near} within rounding of an edge)"),
        }
    }
}

impl Display for Percentiles {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} in the median, {:.1} at p99, {:.1} at most", self.p50, self.p99, self.max)
    }
}

impl Percentiles {
    /// None of nothing. Sorts the numbers partly.
    #[must_use]
    pub fn of(numbers: &mut [f64]) -> Option<Self> {
        let last = numbers.len().checked_sub(1)?;
        let mut at = |rank: usize| *numbers.select_nth_unstable_by(rank, f64::total_cmp).1;
        Some(Self { p50: at(last / 2), p99: at((last * 99).div_ceil(100)), max: at(last) })
    }
}

impl Tally {
    fn closest(&mut self, tracer: &Tracer<'_>, rays: &RaySet, row: usize, hits: &Hits) {
        let Some(stretch) = rays.stretch(row) else { return };
        let truth = tracer.closest(&stretch);
        let found = (hits.id[row] != Hits::MISS).then_some(PrimitiveId(hits.id[row]));
        self.errors.rays += 1;
        self.errors.hits += u64::from(truth.is_some());
        match (truth, found) {
            (Some(met), Some(id)) if met.id == id => {
                self.same(&met, stretch.direction, hits.t[row], rays.found.get(row));
            }
            (None, None) => {}
            (truth, found) => {
                let id = truth.map(|met| met.id);
                let is_certain = tracer.certain_closest(&stretch) == Some(id);
                let wrong = match (id, found) {
                    (None, _) => &mut self.errors.false_hits,
                    (_, None) => &mut self.errors.false_misses,
                    _ => &mut self.errors.other_primitives,
                };
                wrong.count(is_certain);
            }
        }
    }

    fn any(&mut self, tracer: &Tracer<'_>, rays: &RaySet, row: usize, hits: &Hits) {
        let Some(stretch) = rays.stretch(row) else { return };
        let truth = tracer.occluded(&stretch);
        let found = hits.t[row].is_finite();
        self.errors.rays += 1;
        self.errors.hits += u64::from(truth);
        if truth != found {
            let is_certain = tracer.certain_occluded(&stretch) == Some(truth);
            let wrong = if found { &mut self.errors.false_hits } else { &mut self.errors.false_misses };
            wrong.count(is_certain);
        }
    }

    fn same(&mut self, met: &Met, direction: DVec3, t: f32, found: Option<&Found>) {
        let error = (f64::from(t) - met.t).abs();
        let errors = [error / ulp(met.t), error / met.t_per_rounding];
        // A t beyond f32 has no unit in its last place.
        if errors.into_iter().all(f64::is_finite) && met.t <= f64::from(f32::MAX) {
            self.t_ulps.push(errors[0]);
            self.t_backward.push(errors[1]);
        }
        // Where a frame's normals are known, so is its hit.
        if let Some(found) = found.filter(|found| found.id == Some(met.id)) {
            let side = if direction.dot(met.geometric_normal) < 0.0 { 1.0 } else { -1.0 };
            let normal = DVec3::from(found.shading_normal.map(f64::from));
            const ROUNDINGS_PER_UNIT: f64 = (1 << 24) as f64;
            self.normal.push(normal.distance(side * met.shading_normal) * ROUNDINGS_PER_UNIT);
        }
    }

    fn with(mut self, mut other: Self) -> Self {
        let (mine, others) = (&mut self.errors, &other.errors);
        mine.rays += others.rays;
        mine.hits += others.hits;
        for (mine, other) in [
            (&mut mine.false_hits, others.false_hits),
            (&mut mine.false_misses, others.false_misses),
            (&mut mine.other_primitives, others.other_primitives),
        ] {
            mine.near_edges += other.near_edges;
            mine.certain += other.certain;
        }
        self.t_ulps.append(&mut other.t_ulps);
        self.t_backward.append(&mut other.t_backward);
        self.normal.append(&mut other.normal);
        self
    }
}

impl Wrong {
    pub(super) fn count(&mut self, is_certain: bool) {
        if is_certain {
            self.certain += 1;
        } else {
            self.near_edges += 1;
        }
    }
}

/// The distance from a number > 0, as f32, to the next larger.
pub(super) fn ulp(number: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let rounded = number as f32;
    f64::from(rounded.next_up()) - f64::from(rounded)
}
