//! Formulas timed in turn.

use super::super::RungOptions;
use super::Formula;
use super::columns::{Columns, TILE};
use crate::measure::{Better, Spread};
use crate::render::RenderError;
use std::hint::black_box;
use std::time::Instant;

/// Tiles that stay in the second level cache: 4096 pairs of up to 72 bytes.
const CHUNK: usize = 256;

/// How often a chunk is timed in a round; the median counts.
const TRIES: usize = 5;

/// Seconds of each formula, round by round, for all pairs once, on this thread.
///
/// Chunk by chunk the formulas take turns, so that whatever else the machine does falls on all of them; and what takes the
/// processor away for a time, or the cache, falls on one try of some microseconds and not on the median. So each has its chunk
/// in the cache, as blocks of a hierarchy are that many rays read.
pub(super) fn race<F: Formula<N>, const N: usize>(
    pairs: &Columns<N>,
    options: &RungOptions<'_>,
) -> Result<Vec<Vec<f64>>, RenderError> {
    let mut seconds = vec![vec![0.0; options.rounds()]; F::ALL.len()];
    let mut ts = vec![0.0; CHUNK * TILE];
    for round in 0..options.rounds() {
        options.step(F::PRIMITIVE, round, options.rounds())?;
        for first in (0..pairs.tiles()).step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(pairs.tiles());
            let ts = &mut ts[..chunk.len() * TILE];
            // A clock is read for as many tests as a full chunk has, at least.
            let times = CHUNK.div_ceil(chunk.len());
            for (formula, seconds) in F::ALL.iter().zip(&mut seconds) {
                let tries = [(); TRIES].map(|()| {
                    let start = Instant::now();
                    for _ in 0..times {
                        formula.test(options.width, pairs, black_box(chunk.clone()), black_box(&mut *ts));
                    }
                    start.elapsed().as_secs_f64() / times as f64
                });
                seconds[round] += Spread::of(tries.into(), Better::Less).map_or(0.0, |tries| tries.median);
            }
        }
    }
    Ok(seconds)
}
