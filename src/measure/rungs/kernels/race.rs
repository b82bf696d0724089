//! Formulas timed in turn.

use super::super::RungOptions;
use super::Formula;
use super::columns::{TILE, Tiles};
use crate::measure::{Better, Spread};
use crate::render::RenderError;
use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

/// Bytes of pairs that stay in the second level cache.
const CHUNK: usize = 288 << 10;

/// How often a chunk is timed in a round; the median counts.
const TRIES: usize = 5;

/// Seconds of each formula, round by round, for all pairs once, on this thread.
///
/// Chunk by chunk the formulas take turns, so that whatever else the machine does falls on all of them; and what takes the
/// processor away for a time, or the cache, falls on one try of some microseconds and not on the median. So each has its chunk
/// in the cache, as blocks of a hierarchy are that many rays read.
pub(super) fn race<F: Formula>(
    pairs: &F::Pairs,
    options: &RungOptions<'_>,
) -> Result<Vec<Vec<f64>>, RenderError> {
    let mut seconds = vec![vec![0.0; options.rounds()]; F::ALL.len()];
    let mut ts = Vec::new();
    for round in 0..options.rounds() {
        options.step(F::PRIMITIVE, round, options.rounds())?;
        let mut first = 0;
        while first < pairs.tiles() {
            let (chunk, bytes) = chunk(pairs, first);
            first = chunk.end;
            ts.resize(chunk.len() * TILE, 0.0);
            // A clock is read for as much as a full chunk, at least.
            let times = CHUNK.div_ceil(bytes);
            for (formula, seconds) in F::ALL.iter().zip(&mut seconds) {
                let tries = [(); TRIES].map(|()| {
                    let start = Instant::now();
                    for _ in 0..times {
                        formula.test(options.width, pairs, black_box(chunk.clone()), black_box(&mut ts));
                    }
                    start.elapsed().as_secs_f64() / times as f64
                });
                seconds[round] += Spread::of(tries.into(), Better::Less).map_or(0.0, |tries| tries.median);
            }
        }
    }
    Ok(seconds)
}

/// As many tiles from the first one as fit, one at least, and their bytes.
fn chunk(pairs: &impl Tiles, first: usize) -> (Range<usize>, usize) {
    let (mut end, mut bytes) = (first + 1, pairs.bytes(first));
    while end < pairs.tiles() && bytes + pairs.bytes(end) <= CHUNK {
        bytes += pairs.bytes(end);
        end += 1;
    }
    (first..end, bytes)
}
