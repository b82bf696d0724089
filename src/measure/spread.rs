//! Repeated measurements of one thing in three numbers: the middle, the best, and how far apart they lie.

use serde::Serialize;

/// A summary of repeated measurements, all in one unit.
///
/// The median and the median absolute deviation do not move when a few runs are disturbed, as they are on a machine that
/// does something else as well, and need no convention of how to cut few runs into quarters. The best run is the one that
/// was disturbed least.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The middle one; the mean of the two in the middle where the count is even.
    pub median: f64,
    /// The least or the largest.
    pub best: f64,
    /// The median of the distances from the median; 0 for a single run.
    pub median_absolute_deviation: f64,
    /// How many measurements there were.
    pub runs: usize,
}

/// Which measurements are the better ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// Of seconds, the fewer.
    Less,
    /// Of rays a second, the more.
    More,
}

impl Spread {
    /// Sums up measurements in any order; none where there are none, or where one is infinite or no number.
    #[must_use]
    pub fn of(mut samples: Vec<f64>, better: Better) -> Option<Self> {
        if samples.iter().any(|sample| !sample.is_finite()) {
            return None;
        }
        samples.sort_by(f64::total_cmp);
        let median = middle(&samples)?;
        let best = match better {
            Better::Less => *samples.first()?,
            Better::More => *samples.last()?,
        };
        let mut distances: Vec<f64> = samples.iter().map(|sample| (sample - median).abs()).collect();
        distances.sort_by(f64::total_cmp);
        Some(Self { median, best, median_absolute_deviation: middle(&distances)?, runs: samples.len() })
    }
}

/// The median of sorted numbers.
fn middle(sorted: &[f64]) -> Option<f64> {
    let upper = sorted.len() / 2;
    let lower = sorted.len().checked_sub(1)? / 2;
    Some(f64::midpoint(sorted[lower], sorted[upper]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_numbers_are_those_of_the_definition() {
        for (samples, median, least, most, deviation) in [
            (vec![3.0], 3.0, 3.0, 3.0, 0.0),
            (vec![4.0, 1.0], 2.5, 1.0, 4.0, 1.5),
            // Distances from 3: 2, 1, 0, 1, 97. A disturbed run moves neither median.
            (vec![2.0, 100.0, 3.0, 1.0, 4.0], 3.0, 1.0, 100.0, 1.0),
            // Distances from 2.5: 1.5, 0.5, 0.5, 1.5.
            (vec![1.0, 2.0, 3.0, 4.0], 2.5, 1.0, 4.0, 1.0),
            (vec![5.0; 6], 5.0, 5.0, 5.0, 0.0),
        ] {
            for (better, best) in [(Better::Less, least), (Better::More, most)] {
                let expected =
                    Spread { median, best, median_absolute_deviation: deviation, runs: samples.len() };
                assert_eq!(Spread::of(samples.clone(), better), Some(expected), "{samples:?}");
            }
        }
    }

    #[test]
    fn nothing_measured_is_no_spread() {
        for samples in [vec![], vec![f64::NAN], vec![1.0, f64::INFINITY], vec![f64::NEG_INFINITY, 2.0]] {
            assert_eq!(Spread::of(samples, Better::Less), None);
        }
    }

    #[test]
    fn a_report_has_a_median_and_a_best() {
        let spread = Spread::of(vec![1.0, 2.0, 4.0], Better::More).unwrap();
        let expected =
            serde_json::json!({"median": 2.0, "best": 4.0, "median_absolute_deviation": 1.0, "runs": 3});
        assert_eq!(serde_json::to_value(spread).unwrap(), expected);
    }

    proptest! {
        #[test]
        fn half_of_the_runs_lie_within_the_deviation_of_the_median(
            samples in prop::collection::vec(-1e300..1e300, 1..40)
        ) {
            let spread = Spread::of(samples.clone(), Better::Less).unwrap();
            let count = |holds: &dyn Fn(f64) -> bool| samples.iter().filter(|&&sample| holds(sample)).count();
            prop_assert!(2 * count(&|sample| sample <= spread.median) >= samples.len());
            prop_assert!(2 * count(&|sample| sample >= spread.median) >= samples.len());
            let deviation = spread.median_absolute_deviation;
            prop_assert!(2 * count(&|sample| (sample - spread.median).abs() <= deviation) >= samples.len());
            prop_assert!(2 * count(&|sample| (sample - spread.median).abs() >= deviation) >= samples.len());
            prop_assert_eq!(count(&|sample| sample < spread.best), 0);
        }
    }
}
