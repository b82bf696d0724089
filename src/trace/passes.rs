//! Tracing rays over and over, timed.

use super::columns::{EndColumns, RayColumns};
use super::{Hits, Query};
use crate::lanes::{self, Single, Width};
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::reference::Tracer;
use crate::traverse::{self, Counts, Ends, RUN};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What traces, what for, and how often.
#[derive(Clone, Copy)]
pub struct Tracing<'a> {
    /// What is asked.
    pub query: Query,
    /// Timed passes, at least 1; one more goes before them.
    pub repeat: usize,
    /// Where the work is done.
    pub pool: &'a rayon::ThreadPool,
    /// Set to true, makes it stop after the pass at hand.
    pub stop: &'a AtomicBool,
}

/// What passes over rays found and took.
#[derive(Clone, Debug)]
pub struct Passes {
    /// The same in every pass.
    pub hits: Hits,
    /// Wall-clock seconds of each timed pass.
    pub seconds: Vec<f64>,
}

/// Traces rays with the wavefront engine's kernels, at a number of lanes.
///
/// What is timed begins with rays in columns and ends with hits in columns, both in the scene's scale.
#[must_use]
pub fn trace(prepared: &Prepared<'_>, rays: &RaySet, width: Width, tracing: &Tracing<'_>) -> Passes {
    let columns = RayColumns::new(prepared, rays);
    let ids = if tracing.query == Query::Closest { columns.filled() } else { 0 };
    let mut ends = EndColumns { t: vec![0.0; columns.filled()], id: vec![0; ids] };
    let seconds = timed(tracing, || {
        tracing.pool.install(|| width.run(Pass { prepared, columns: &columns, query: tracing.query, ends: &mut ends }));
    });
    Passes { hits: columns.hits(tracing.query, &ends), seconds }
}

/// Traces rays with the f64 reference.
#[must_use]
pub fn trace_with_reference(tracer: &Tracer<'_>, rays: &RaySet, tracing: &Tracing<'_>) -> Passes {
    let mut hits = Hits { t: vec![0.0; rays.len()], id: vec![0; rays.len()] };
    let seconds = timed(tracing, || {
        tracing.pool.install(|| {
            (&mut hits.t, &mut hits.id).into_par_iter().enumerate().with_min_len(RUN).for_each(|(row, (t, id))| {
                (*t, *id) = reference_hit(tracer, rays, row, tracing.query);
            });
        });
    });
    Passes { hits, seconds }
}

fn reference_hit(tracer: &Tracer<'_>, rays: &RaySet, row: usize, query: Query) -> (f32, u32) {
    let miss = (f32::INFINITY, Hits::MISS);
    let Some(stretch) = rays.stretch(row) else { return miss };
    match query {
        Query::Closest => tracer.closest(&stretch).map_or(miss, |met| {
            #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
            let t = met.t as f32;
            (t.min(f32::MAX), met.id.0)
        }),
        Query::Any if tracer.occluded(&stretch) => (0.0, Hits::MISS),
        Query::Any => miss,
    }
}

/// Seconds of passes, the first of which is not counted.
fn timed(tracing: &Tracing<'_>, mut pass: impl FnMut()) -> Vec<f64> {
    pass();
    let mut seconds = Vec::with_capacity(tracing.repeat);
    while seconds.len() < tracing.repeat.max(1) && !(tracing.stop.load(Ordering::Relaxed) && !seconds.is_empty()) {
        let start = Instant::now();
        pass();
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds
}

/// Rays that a thread traces before it looks for more: enough to make up for starting, little enough to share.
const CHUNK: usize = 128 * RUN;

/// One pass over all rays.
struct Pass<'a> {
    prepared: &'a Prepared<'a>,
    columns: &'a RayColumns,
    query: Query,
    ends: &'a mut EndColumns,
}

impl lanes::Job for Pass<'_> {
    type Output = Counts;

    fn run<F: Single>(self) -> Counts {
        let Self { prepared, columns, query, ends } = self;
        let chunk = |index: usize, ends: &mut Ends<'_>| {
            let rows = index * CHUNK..index * CHUNK + ends.t.len();
            let rays = columns.rays(&rows);
            columns.begin(&rows, ends);
            let mut counts = Counts::default();
            match query {
                Query::Closest => traverse::closest::<F>(&prepared.hierarchy, &rays, ends, &mut counts),
                Query::Any => traverse::occluded::<F>(&prepared.hierarchy, &rays, ends, &mut counts),
            }
            counts
        };
        let sum = |mut a: Counts, b: Counts| {
            a += b;
            a
        };
        let ts = ends.t.par_chunks_mut(CHUNK).enumerate();
        match query {
            Query::Closest => ts
                .zip(ends.id.par_chunks_mut(CHUNK))
                .map(|((index, t), id)| chunk(index, &mut Ends { t, id }))
                .reduce(Counts::default, sum),
            Query::Any => {
                ts.map(|(index, t)| chunk(index, &mut Ends { t, id: &mut [] })).reduce(Counts::default, sum)
            }
        }
    }
}
