//! What rays hit in truth, and whether an engine found that.

use wavelane::measure::HitErrors;
use wavelane::rays::RaySet;
use wavelane::reference::Tracer;
use wavelane::trace::{Hits, Query, ReferenceRun};

/// The f64 reference's answer.
pub(crate) struct Truth<'a> {
    tracer: &'a Tracer<'a>,
    rays: &'a RaySet,
    query: Query,
    hits: Hits,
}

impl<'a> Truth<'a> {
    pub(crate) fn new(tracer: &'a Tracer<'a>, rays: &'a RaySet, query: Query) -> Self {
        let mut run = ReferenceRun::new(tracer, rays, query);
        run.pass(&rayon::ThreadPoolBuilder::new().build().unwrap());
        let hits = run.hits().clone();
        assert!(hits.count() > 0, "rays of which none hits would be traced in no time");
        Self { tracer, rays, query, hits }
    }

    /// That an engine of ours found the truth: as many hits, of the same primitives, but for rays that pass an edge within
    /// rounding, where no answer is wrong.
    pub(crate) fn assert_found_by_us(&self, found: &Hits) {
        let differing = self.differing(found);
        let errors = self.errors(found, &differing);
        assert_eq!(errors.mistakes(), 0, "{errors}");
        self.assert_rare(found, &differing, 1000);
    }

    /// That another tracer did, which may know nothing of our bounds on rounding: but for `one_in` so many.
    pub(crate) fn assert_found_by_another(&self, found: &Hits, one_in: usize) {
        self.assert_rare(found, &self.differing(found), one_in);
    }

    fn assert_rare(&self, found: &Hits, differing: &[usize], one_in: usize) {
        let (hits, truth, rays) = (found.count(), self.hits.count(), self.rays.len());
        assert!(
            differing.len() * one_in <= rays,
            "{hits} hits, {truth} in truth; {} of {rays} rays differ",
            differing.len()
        );
    }

    /// Rays that hit something else than in truth.
    fn differing(&self, found: &Hits) -> Vec<usize> {
        assert_eq!(found.t.len(), self.rays.len());
        let differs = |&row: &usize| {
            found.id[row] != self.hits.id[row] || found.t[row].is_finite() != self.hits.t[row].is_finite()
        };
        (0..self.rays.len()).filter(differs).collect()
    }

    fn errors(&self, found: &Hits, rows: &[usize]) -> HitErrors {
        let rays =
            RaySet { rows: rows.iter().map(|&row| self.rays.rows[row]).collect(), ..RaySet::default() };
        let hits = Hits {
            t: rows.iter().map(|&row| found.t[row]).collect(),
            id: rows.iter().map(|&row| found.id[row]).collect(),
        };
        HitErrors::measure(self.tracer, &rays, self.query, &hits)
    }
}
