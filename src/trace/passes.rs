//! Passes over all rays, timed.

use super::columns::{EndColumns, RayColumns};
use super::{Hits, Query, TestsMade};
use crate::lanes::{self, Single, Width};
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::reference::Tracer;
use crate::traverse::{self, Counts, Ends, RUN, Shuffled, Walkers};
use rayon::prelude::*;
use std::ops::Add;
use std::time::Instant;

/// Rays to be traced by the wavefront engine's kernels.
pub struct Run<'a> {
    prepared: &'a Prepared<'a>,
    columns: &'a RayColumns,
    query: Query,
    ends: EndColumns,
    counts: Counts,
    walkers: Walkers,
    shuffled: Shuffled,
}

impl<'a> Run<'a> {
    /// Makes room for what will be hit.
    #[must_use]
    pub fn new(prepared: &'a Prepared<'a>, columns: &'a RayColumns, query: Query) -> Self {
        let ids = if query == Query::Closest { columns.filled() } else { 0 };
        Self {
            prepared,
            columns,
            query,
            ends: EndColumns { t: vec![0.0; columns.filled()], id: vec![0; ids] },
            counts: Counts::default(),
            walkers: Walkers::default(),
            shuffled: Shuffled::default(),
        }
    }

    /// Traces all rays once, on the threads of a pool, and returns wall-clock seconds: from rays in columns to hits in
    /// columns, both in the scene's scale.
    pub fn pass(&mut self, width: Width, pool: &rayon::ThreadPool) -> f64 {
        let Self { prepared, columns, query, ends, counts, walkers, shuffled } = self;
        let start = Instant::now();
        *counts =
            pool.install(|| width.run(Pass { prepared, columns, query: *query, ends, walkers, shuffled }));
        start.elapsed().as_secs_f64()
    }

    /// Where rays ended in the last pass, in the scene's scale: the t of their hit, or of their end where they hit nothing;
    /// below 0 for what is no ray.
    pub(crate) fn ends(&self) -> &[f32] {
        &self.ends.t
    }

    /// How many rays of the last pass walked in packets; the others walked in streams.
    #[must_use]
    pub fn in_packets(&self) -> u64 {
        self.counts.in_packets
    }

    /// What the last pass took; none where there are no rays.
    #[must_use]
    pub fn tests(&self) -> Option<TestsMade> {
        TestsMade::new(&self.counts, self.columns.count())
    }

    /// What the last pass found.
    #[must_use]
    pub fn hits(&self) -> Hits {
        self.columns.hits(self.query, &self.ends)
    }
}

/// Rays to be traced by the f64 reference.
pub struct ReferenceRun<'a> {
    tracer: &'a Tracer<'a>,
    rays: &'a RaySet,
    query: Query,
    hits: Hits,
}

impl<'a> ReferenceRun<'a> {
    /// Makes room for what will be hit.
    #[must_use]
    pub fn new(tracer: &'a Tracer<'a>, rays: &'a RaySet, query: Query) -> Self {
        Self { tracer, rays, query, hits: Hits { t: vec![0.0; rays.len()], id: vec![0; rays.len()] } }
    }

    /// Traces all rays once, on the threads of a pool, and returns wall-clock seconds.
    pub fn pass(&mut self, pool: &rayon::ThreadPool) -> f64 {
        let Self { tracer, rays, query, hits } = self;
        let start = Instant::now();
        pool.install(|| {
            let rows = (&mut hits.t, &mut hits.id).into_par_iter().enumerate().with_min_len(RUN);
            rows.for_each(|(row, (t, id))| (*t, *id) = reference_hit(tracer, rays, row, *query));
        });
        start.elapsed().as_secs_f64()
    }

    /// What the last pass found.
    #[must_use]
    pub fn hits(&self) -> &Hits {
        &self.hits
    }
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

/// One pass over all rays.
struct Pass<'a> {
    prepared: &'a Prepared<'a>,
    columns: &'a RayColumns,
    query: Query,
    ends: &'a mut EndColumns,
    walkers: &'a Walkers,
    shuffled: &'a mut Shuffled,
}

impl lanes::Job for Pass<'_> {
    type Output = Counts;

    fn run<F: Single>(self) -> Counts {
        let columns = self.columns;
        if traverse::is_local(columns.rays().origin, columns.count()) {
            self.in_order::<F>()
        } else {
            self.in_no_order::<F>()
        }
    }
}

impl Pass<'_> {
    fn in_order<F: Single>(self) -> Counts {
        let Self { prepared, columns, query, ends, walkers, .. } = self;
        let batch = traverse::batch(columns.filled(), rayon::current_num_threads());
        let trace = |index: usize, ends: &mut Ends<'_>| {
            let rows = index * batch..index * batch + ends.t.len();
            let rays = columns.rays().rows(rows.clone());
            columns.begin(&rows, ends);
            let mut counts = Counts::default();
            walkers.lend(|walker| match query {
                Query::Closest => walker.closest::<F>(&prepared.hierarchy, &rays, ends, &mut counts),
                Query::Any => walker.occluded::<F>(&prepared.hierarchy, &rays, ends, &mut counts),
            });
            counts
        };
        // Batches differ in cost: without this, half of them would be one task, and no thread could take another's.
        let ts = ends.t.par_chunks_mut(batch).with_max_len(1).enumerate();
        match query {
            Query::Closest => ts
                .zip(ends.id.par_chunks_mut(batch))
                .map(|((index, t), id)| trace(index, &mut Ends { t, id }))
                .reduce(Counts::default, Counts::add),
            Query::Any => ts
                .map(|(index, t)| trace(index, &mut Ends { t, id: &mut [] }))
                .reduce(Counts::default, Counts::add),
        }
    }

    fn in_no_order<F: Single>(self) -> Counts {
        let Self { prepared, columns, query, ends, walkers, shuffled } = self;
        let hierarchy = &prepared.hierarchy;
        let rays = (&columns.rays(), columns.t_max());
        let EndColumns { t, id } = ends;
        let mut ends = Ends { t, id };
        match query {
            Query::Closest => shuffled.trace::<F, false>(hierarchy, rays, &mut ends, walkers),
            Query::Any => shuffled.trace::<F, true>(hierarchy, rays, &mut ends, walkers),
        }
    }
}
