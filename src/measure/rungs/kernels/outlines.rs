//! Pairs of ray and polygon in tiles of one shape.

use super::columns::{TILE, Tiles};
use crate::lanes::Single;
use std::collections::HashMap;
use std::ops::Range;

/// Origin, direction, shear, t per z, a point of the plane and its normal; the world's axes, the scale of the prepared scene.
pub(super) type Head = [f32; 15];

/// What all pairs of a tile share: a packet of rays has one order of axes too, and its polygon one number of corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Shape {
    pub(super) corners: usize,
    /// The axis along which the ray is fastest.
    pub(super) third: usize,
    /// The axis along which the normal is largest.
    pub(super) steepest: usize,
}

/// Pairs of ray and polygon, tiled by their shapes.
#[derive(Default)]
pub(super) struct Outlines {
    tiles: Vec<Tile>,
    /// x, y and z of corners: of a tile's pairs their first ones, then their second ones, and so on.
    corners: Vec<[[f32; TILE]; 3]>,
    /// Of each pair.
    places: Vec<usize>,
    /// Tiles that have room.
    open: HashMap<Shape, usize>,
}

struct Tile {
    heads: [[f32; TILE]; 15],
    shape: Shape,
    first_corner: usize,
    count: usize,
}

impl Tiles for Outlines {
    fn pairs(&self) -> usize {
        self.places.len()
    }

    fn tiles(&self) -> usize {
        self.tiles.len()
    }

    fn place(&self, pair: usize) -> usize {
        self.places[pair]
    }

    fn bytes(&self, tile: usize) -> usize {
        size_of::<Tile>() + self.tiles[tile].shape.corners * size_of::<[[f32; TILE]; 3]>()
    }
}

impl Outlines {
    /// `corner` says where a corner is, in the world's axes.
    pub(super) fn push(&mut self, head: &Head, shape: Shape, corner: impl Fn(usize) -> [f32; 3]) {
        let tile = *self.open.entry(shape).or_insert_with(|| {
            let first_corner = self.corners.len();
            self.tiles.push(Tile { heads: [[0.0; TILE]; 15], shape, first_corner, count: 0 });
            self.corners.resize(first_corner + shape.corners, [[0.0; TILE]; 3]);
            self.tiles.len() - 1
        });
        let Tile { heads, first_corner, count, .. } = &mut self.tiles[tile];
        // The first pair of a tile fills it up.
        let lanes = if *count == 0 { 0..TILE } else { *count..*count + 1 };
        for (column, number) in heads.iter_mut().zip(head) {
            column[lanes.clone()].fill(*number);
        }
        for (index, corners) in self.corners[*first_corner..][..shape.corners].iter_mut().enumerate() {
            for (column, coordinate) in corners.iter_mut().zip(corner(index)) {
                column[lanes.clone()].fill(coordinate);
            }
        }
        self.places.push(tile * TILE + *count);
        *count += 1;
        if *count == TILE {
            self.open.remove(&shape);
        }
    }

    /// A pair and its corners.
    pub(super) fn row(&self, pair: usize) -> (Head, Vec<[f32; 3]>) {
        let (tile, lane) = (self.places[pair] / TILE, self.places[pair] % TILE);
        let Tile { heads, shape, first_corner, .. } = &self.tiles[tile];
        let corners = &self.corners[*first_corner..][..shape.corners];
        let corners = corners.iter().map(|columns| columns.map(|column| column[lane]));
        (heads.map(|column| column[lane]), corners.collect())
    }

    /// Corners of all pairs.
    pub(super) fn edges(&self) -> u64 {
        self.tiles.iter().map(|tile| (tile.count * tile.shape.corners) as u64).sum()
    }

    /// Answers a run of tiles: a t for each place, infinite on a miss.
    #[inline(always)]
    pub(super) fn test<F: Single>(
        &self,
        tiles: Range<usize>,
        ts: &mut [f32],
        test: impl Fn(&Lane<'_>) -> (F, F::Mask),
    ) {
        let miss = F::splat(f32::INFINITY);
        for (tile, ts) in self.tiles[tiles].iter().zip(ts.chunks_exact_mut(TILE)) {
            let corners = &self.corners[tile.first_corner..][..tile.shape.corners];
            for first in (0..TILE).step_by(F::WIDTH) {
                let (t, hit) = test(&Lane { tile, corners, first });
                F::select(hit, t, miss).store(&mut ts[first..]);
            }
        }
    }
}

/// A place in a tile from which lanes are read.
pub(super) struct Lane<'a> {
    tile: &'a Tile,
    pub(super) corners: &'a [[[f32; TILE]; 3]],
    first: usize,
}

impl Lane<'_> {
    #[inline(always)]
    pub(super) fn shape(&self) -> Shape {
        self.tile.shape
    }

    /// Of the head.
    #[inline(always)]
    pub(super) fn load<F: Single>(&self, column: usize) -> F {
        F::load(&self.tile.heads[column][self.first..])
    }

    /// A coordinate of a corner.
    #[inline(always)]
    pub(super) fn coordinate<F: Single>(&self, corner: &[[f32; TILE]; 3], axis: usize) -> F {
        F::load(&corner[axis][self.first..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Job, Width};

    struct Sums<'a>(&'a Outlines, &'a mut [f32]);

    impl Job for Sums<'_> {
        type Output = ();

        fn run<F: Single>(self) {
            let Self(outlines, ts) = self;
            outlines.test::<F>(0..outlines.tiles(), ts, |lane| {
                let mut sum = lane.load::<F>(0);
                for corner in lane.corners {
                    sum = sum + lane.coordinate::<F>(corner, 1);
                }
                (sum, sum.gt(F::splat(50.0)))
            });
        }
    }

    #[test]
    fn every_pair_is_tested_once_beside_pairs_of_its_shape_at_any_width() {
        let mut outlines = Outlines::default();
        let corners_of = |pair: u16| 3 + usize::from(pair % 3);
        for pair in 0..100_u16 {
            let shape = Shape { corners: corners_of(pair), third: usize::from(pair) % 2, steepest: 2 };
            outlines.push(&[f32::from(pair); 15], shape, |corner| [0.0, corner as f32, 0.0]);
        }
        // Six shapes of 16 or 17 pairs each.
        assert_eq!(outlines.pairs(), 100);
        assert_eq!(outlines.tiles(), 10);
        assert_eq!(outlines.edges(), (0..100).map(|pair| corners_of(pair) as u64).sum::<u64>());
        for width in Width::ALL {
            let mut ts = vec![0.0; outlines.tiles() * TILE];
            width.run(Sums(&outlines, &mut ts));
            for pair in 0..100_u16 {
                let count = corners_of(pair);
                let sum = f32::from(pair) + (0..count).map(|corner| corner as f32).sum::<f32>();
                let expected = if sum > 50.0 { sum } else { f32::INFINITY };
                assert_eq!(ts[outlines.place(usize::from(pair))], expected, "pair {pair}, {width:?}");
                let (head, corners) = outlines.row(usize::from(pair));
                assert_eq!((head[14], corners.len(), corners[2][1]), (f32::from(pair), count, 2.0));
            }
        }
    }
}
