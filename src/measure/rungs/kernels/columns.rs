//! Numbers of pairs in columns.

use crate::lanes::Single;
use std::ops::Range;

/// Rows of a tile: as many as the widest lanes.
pub(super) const TILE: usize = 16;

/// Pairs in tiles, as lanes read them; where a tile is not full, pairs that are in it fill it up.
pub(super) trait Tiles: Sync {
    /// How many pairs there are.
    fn pairs(&self) -> usize;
    /// How many tiles.
    fn tiles(&self) -> usize;
    /// Where a pair lies: [`TILE`] places a tile.
    fn place(&self, pair: usize) -> usize;
    /// What a tile takes of the cache.
    fn bytes(&self, tile: usize) -> usize;
}

/// Rows of N numbers, in tiles of [`TILE`] rows; in a tile, a column a number.
#[derive(Default)]
pub(super) struct Columns<const N: usize> {
    tiles: Vec<[[f32; TILE]; N]>,
    count: usize,
}

impl<const N: usize> Tiles for Columns<N> {
    fn pairs(&self) -> usize {
        self.count
    }

    fn tiles(&self) -> usize {
        self.tiles.len()
    }

    fn place(&self, pair: usize) -> usize {
        pair
    }

    fn bytes(&self, _: usize) -> usize {
        size_of::<[[f32; TILE]; N]>()
    }
}

impl<const N: usize> Columns<N> {
    pub(super) fn push(&mut self, row: [f32; N]) {
        let lane = self.count % TILE;
        if lane == 0 {
            self.tiles.push(row.map(|number| [number; TILE]));
        } else if let Some(tile) = self.tiles.last_mut() {
            for (column, number) in tile.iter_mut().zip(row) {
                column[lane] = number;
            }
        }
        self.count += 1;
    }

    pub(super) fn row(&self, row: usize) -> [f32; N] {
        let tile = &self.tiles[row / TILE];
        std::array::from_fn(|column| tile[column][row % TILE])
    }

    /// Answers a run of tiles: a t for each row, infinite on a miss.
    #[inline(always)]
    pub(super) fn test<F: Single>(
        &self,
        tiles: Range<usize>,
        ts: &mut [f32],
        test: impl Fn(&Lane<'_, N>) -> (F, F::Mask),
    ) {
        let miss = F::splat(f32::INFINITY);
        for (tile, ts) in self.tiles[tiles].iter().zip(ts.chunks_exact_mut(TILE)) {
            for first in (0..TILE).step_by(F::WIDTH) {
                let (t, hit) = test(&Lane { tile, first });
                F::select(hit, t, miss).store(&mut ts[first..]);
            }
        }
    }
}

/// A place in a tile from which lanes are read.
pub(super) struct Lane<'a, const N: usize> {
    tile: &'a [[f32; TILE]; N],
    first: usize,
}

impl<const N: usize> Lane<'_, N> {
    #[inline(always)]
    pub(super) fn load<F: Single>(&self, column: usize) -> F {
        F::load(&self.tile[column][self.first..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Job, Width};

    struct Sums<'a>(&'a Columns<2>, &'a mut [f32]);

    impl Job for Sums<'_> {
        type Output = ();

        fn run<F: Single>(self) {
            let Self(columns, ts) = self;
            columns.test::<F>(0..columns.tiles(), ts, |lane| {
                let (a, b) = (lane.load::<F>(0), lane.load::<F>(1));
                (a + b, a.gt(F::splat(3.0)))
            });
        }
    }

    #[test]
    fn every_row_is_tested_once_at_any_width() {
        let mut columns = Columns::default();
        let rows: Vec<[f32; 2]> = (0..37_u8).map(|row| [f32::from(row), 0.5]).collect();
        rows.iter().for_each(|&row| columns.push(row));
        assert_eq!((columns.pairs(), columns.tiles()), (37, 3));
        for width in Width::ALL {
            let mut ts = vec![0.0; columns.tiles() * TILE];
            width.run(Sums(&columns, &mut ts));
            for (row, &t) in ts.iter().enumerate().take(37) {
                let [a, b] = rows[row];
                assert_eq!(columns.row(row), rows[row]);
                assert_eq!(t, if a > 3.0 { a + b } else { f32::INFINITY }, "row {row}, {width:?}");
            }
        }
    }
}
