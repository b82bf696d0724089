//! Answers about pairs against the truth.

use super::super::super::hit_errors::{Percentiles, Wrong, ulp};
use crate::reference::PairTruth;
use serde::Serialize;

/// How wrong answers about pairs of ray and primitive are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PairErrors {
    /// Pairs that are hits in truth.
    pub hits: u64,
    /// Pairs that hit, though in truth they miss.
    pub false_hits: Wrong,
    /// Pairs that miss, though in truth they hit.
    pub false_misses: Wrong,
    /// Pairs that hit a sphere on the other side than in truth.
    pub other_sides: Wrong,
    /// Of t where the hit is the true one, in units in the last place of the true t as f32; none without such pairs.
    pub t_ulps: Option<Percentiles>,
    /// Of t, in what rounding the primitive's place once does to it: see [`Met::t_per_rounding`](crate::reference::Met).
    pub t_backward: Option<Percentiles>,
}

impl PairErrors {
    /// Compares answers, infinite on a miss, with the truth, pair by pair.
    pub(super) fn of(truths: &[PairTruth], ts: &[f32]) -> Self {
        let mut errors = Self::default();
        let (mut ulps, mut backward) = (Vec::new(), Vec::new());
        for (truth, &t) in truths.iter().zip(ts) {
            let found = t.is_finite().then_some(f64::from(t));
            errors.hits += u64::from(truth.t.is_some());
            match (truth.t, found) {
                (None, None) => {}
                (None, Some(_)) => errors.false_hits.count(truth.decision_is_certain),
                (Some(_), None) => errors.false_misses.count(truth.decision_is_certain),
                (Some(_), Some(t)) if is_on_other_side(truth, t) => {
                    errors.other_sides.count(truth.side_is_certain);
                }
                (Some(true_t), Some(t)) => {
                    let error = (t - true_t).abs();
                    ulps.push(error / ulp(true_t));
                    backward.push(error / truth.t_per_rounding);
                }
            }
        }
        Self { t_ulps: Percentiles::of(&mut ulps), t_backward: Percentiles::of(&mut backward), ..errors }
    }

    /// Answers that no rounding explains.
    #[must_use]
    pub fn mistakes(&self) -> u64 {
        self.false_hits.certain + self.false_misses.certain + self.other_sides.certain
    }

    /// Wrong answers that rounding explains.
    #[must_use]
    pub fn near_edges(&self) -> u64 {
        self.false_hits.near_edges + self.false_misses.near_edges + self.other_sides.near_edges
    }
}

/// Whether a hit is nearer to the other side of the sphere, and these can be told apart.
fn is_on_other_side(truth: &PairTruth, t: f64) -> bool {
    let (Some(true_t), Some(other_t)) = (truth.t, truth.other_t) else { return false };
    truth.decision_is_certain && (t - other_t).abs() < (t - true_t).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_counted_by_how_they_are_wrong() {
        let sphere = |z: f32| PairTruth::of_sphere([[0.0, 0.0, z], [0.0, 0.0, -1.0]], [0.0; 3], 1.0);
        let limb = PairTruth::of_sphere([[1.0, 0.0, 3.0], [0.0, 0.0, -1.0]], [0.0; 3], 1.0);
        let behind = sphere(-3.0);
        let truths = [sphere(3.0), sphere(3.0), sphere(3.0), behind, limb, sphere(1.0), behind];
        let found = [2.0_f32.next_up(), 4.0, f32::INFINITY, 1.0, f32::INFINITY, 1e-9, f32::INFINITY];
        let errors = PairErrors::of(&truths, &found);
        assert_eq!(errors.hits, 5);
        assert_eq!(errors.false_hits, Wrong { near_edges: 0, certain: 1 });
        assert_eq!(errors.false_misses, Wrong { near_edges: 1, certain: 1 });
        assert_eq!(errors.other_sides, Wrong { near_edges: 1, certain: 1 });
        assert_eq!((errors.mistakes(), errors.near_edges()), (3, 2));
        assert_eq!(errors.t_ulps, Some(Percentiles { p50: 1.0, p99: 1.0, max: 1.0 }));
        // An ulp of 2 is 2⁻²², and a rounding there 4·2⁻²⁴: the farthest point is 4 away and met head-on.
        assert_eq!(errors.t_backward.map(|backward| backward.max), Some(1.0));
    }

    #[test]
    fn nothing_has_no_percentiles() {
        assert_eq!(PairErrors::of(&[], &[]), PairErrors::default());
    }
}
