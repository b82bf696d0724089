//! The image cut into tiles, and a tile into samples, in an order that keeps neighbours together.

use crate::film::Region;

/// A sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sample {
    /// Column of the full image.
    pub(super) x: u32,
    /// Row of the full image from the top.
    pub(super) y: u32,
    /// Number of the sample within its pixel.
    pub(super) s: u32,
    /// Number of the pixel within its tile.
    pub(super) pixel: u32,
}

/// Square tiles that cover a region; those at its edge are cut.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    region: Region,
    samples_per_pixel: u32,
    /// A power of two, pixels.
    side: u32,
    across: u64,
    /// Pixels of a whole tile along a Z-shaped curve, so that any run of them lies close together.
    curve: Vec<[u32; 2]>,
}

/// What is left of a tile's samples.
pub(super) struct Samples<'a> {
    tiles: &'a Tiles,
    tile: Region,
    /// Pixels along the curve that are still to come.
    pixels: std::slice::Iter<'a, [u32; 2]>,
    /// The next sample of a pixel that is not done, and the pixel.
    begun: Option<(u32, [u32; 2])>,
}

impl Tiles {
    /// Pixels of a side at most.
    const LARGEST_SIDE: u32 = 64;

    /// Tiles with about as many samples as a batch has rows.
    pub(super) fn new(region: Region, samples_per_pixel: u32, batch: usize) -> Self {
        let pixels = (batch as u64 / u64::from(samples_per_pixel)).max(1);
        let side: u32 = 1 << (pixels.ilog2() / 2).min(Self::LARGEST_SIDE.ilog2());
        let curve = (0..side * side).map(|place| [every_other_bit(place), every_other_bit(place >> 1)]);
        let across = u64::from(region.width().div_ceil(side));
        Self { region, samples_per_pixel, side, across, curve: curve.collect() }
    }

    pub(super) fn count(&self) -> u64 {
        self.across * u64::from(self.region.height().div_ceil(self.side))
    }

    /// The part of the region that a tile covers.
    pub(super) fn tile(&self, index: u64) -> Region {
        #[expect(clippy::cast_possible_truncation, reason = "a column and a row of a grid within 32 bits")]
        let (column, row) = ((index % self.across) as u32, (index / self.across) as u32);
        let (x0, y0) = (self.region.x0 + column * self.side, self.region.y0 + row * self.side);
        let (x1, y1) = (x0.saturating_add(self.side), y0.saturating_add(self.side));
        Region { x0, y0, x1: x1.min(self.region.x1), y1: y1.min(self.region.y1) }
    }

    /// All samples of a tile. Those of a pixel follow each other in order.
    pub(super) fn samples(&self, tile: Region) -> Samples<'_> {
        Samples { tiles: self, tile, pixels: self.curve.iter(), begun: None }
    }
}

impl Samples<'_> {
    /// Puts in the next samples, as many as fit; none once all are done.
    pub(super) fn fill(&mut self, batch: &mut Vec<Sample>, room: usize) {
        batch.clear();
        if self.tiles.samples_per_pixel == 1 && self.tile.pixels() == self.tiles.curve.len() as u64 {
            return self.fill_with_pixels(batch, room);
        }
        while batch.len() < room {
            let Some((mut s, [dx, dy])) = self.begun.take().or_else(|| self.next_pixel()) else { return };
            let (x, y) = (self.tile.x0 + dx, self.tile.y0 + dy);
            let pixel = dy * self.tile.width() + dx;
            while s < self.tiles.samples_per_pixel && batch.len() < room {
                batch.push(Sample { x, y, s, pixel });
                s += 1;
            }
            self.begun = (s < self.tiles.samples_per_pixel).then_some((s, [dx, dy]));
        }
    }

    /// Of a whole tile with one sample a pixel, which takes no counting and no looking at the edge.
    fn fill_with_pixels(&mut self, batch: &mut Vec<Sample>, room: usize) {
        let left = self.pixels.as_slice();
        let (now, later) = left.split_at(room.min(left.len()));
        let Region { x0, y0, .. } = self.tile;
        let side = self.tiles.side;
        batch.extend(now.iter().map(|&[dx, dy]| Sample {
            x: x0 + dx,
            y: y0 + dy,
            s: 0,
            pixel: dy * side + dx,
        }));
        self.pixels = later.iter();
    }

    fn next_pixel(&mut self) -> Option<(u32, [u32; 2])> {
        let (width, height) = (self.tile.width(), self.tile.height());
        self.pixels.find(|[dx, dy]| *dx < width && *dy < height).map(|&pixel| (0, pixel))
    }
}

/// Bits 0, 2, 4, … put side by side. Morton, "A Computer Oriented Geodetic Data Base", 1966.
fn every_other_bit(word: u32) -> u32 {
    (0..16).fold(0, |bits, bit| bits | ((word >> (2 * bit) & 1) << bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn runs_of_a_tile_are_squares() {
        let tiles = Tiles::new(Region::whole(64, 64), 1, 4096);
        let (mut left, mut run) = (tiles.samples(tiles.tile(0)), Vec::new());
        for square in 0..64 {
            left.fill(&mut run, 64);
            let corner = (
                square & 1 | square >> 1 & 2 | square >> 2 & 4,
                square >> 1 & 1 | square >> 2 & 2 | square >> 3 & 4,
            );
            assert!(
                run.iter().all(|sample| (sample.x / 8, sample.y / 8) == corner),
                "square {square}: {run:?}"
            );
        }
    }

    #[test]
    fn each_sample_of_a_region_comes_once() {
        for (region, samples, batch) in [
            (Region { x0: 3, y0: 5, x1: 140, y1: 70 }, 1, 4096),
            (Region { x0: 0, y0: 0, x1: 9, y1: 1 }, 16, 256),
            (Region { x0: 7, y0: 2, x1: 8, y1: 3 }, 4096, 1024),
        ] {
            let tiles = Tiles::new(region, samples, batch);
            let mut seen = HashSet::new();
            for index in 0..tiles.count() {
                let tile = tiles.tile(index);
                assert!(tile.fits(region.x1, region.y1));
                let mut last = None;
                let (mut left, mut run) = (tiles.samples(tile), Vec::new());
                loop {
                    left.fill(&mut run, 100);
                    if run.is_empty() {
                        break;
                    }
                    for &sample in &run {
                        assert!(seen.insert((sample.x, sample.y, sample.s)), "{sample:?} came twice");
                        assert_eq!(sample.pixel, (sample.y - tile.y0) * tile.width() + sample.x - tile.x0);
                        let follows = last
                            .is_some_and(|last: Sample| last.pixel == sample.pixel && last.s + 1 == sample.s);
                        assert!(sample.s == 0 || follows, "samples of a pixel stay in order");
                        last = Some(sample);
                    }
                }
            }
            assert_eq!(seen.len() as u64, region.pixels() * u64::from(samples));
        }
    }
}
