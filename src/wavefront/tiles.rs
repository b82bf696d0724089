//! The image cut into tiles, and a tile into samples, in an order that keeps neighbours together.

use crate::film::Region;

/// A sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sample {
    /// Column of the full image.
    pub(super) x: u32,
    /// Row of the full image from the top.
    pub(super) y: u32,
    /// Row of the full image from the bottom.
    pub(super) row_from_bottom: u32,
    /// Number of the sample within its pixel.
    pub(super) s: u32,
    /// Number of the pixel within its tile.
    pub(super) pixel: u32,
}

/// Square tiles that cover a region; those at its edge are cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    region: Region,
    /// A power of two, pixels.
    side: u32,
    across: u64,
}

impl Tiles {
    /// Pixels of a side at most.
    pub(super) const LARGEST_SIDE: u32 = 64;

    /// Tiles with about as many samples as a batch has rows.
    pub(super) fn new(region: Region, samples_per_pixel: u32, batch: usize) -> Self {
        let pixels = (batch as u64 / u64::from(samples_per_pixel)).max(1);
        let side = 1 << (pixels.ilog2() / 2).min(Self::LARGEST_SIDE.ilog2());
        Self { region, side, across: u64::from(region.width().div_ceil(side)) }
    }

    pub(super) fn count(&self) -> u64 {
        self.across * u64::from(self.region.height().div_ceil(self.side))
    }

    /// The part of the region that a tile covers.
    pub(super) fn tile(&self, index: u64) -> Region {
        #[expect(clippy::cast_possible_truncation, reason = "a column and a row of a grid within 32 bits")]
        let (column, row) = ((index % self.across) as u32, (index / self.across) as u32);
        let (x0, y0) = (self.region.x0 + column * self.side, self.region.y0 + row * self.side);
        Region { x0, y0, x1: (x0 + self.side).min(self.region.x1), y1: (y0 + self.side).min(self.region.y1) }
    }

    /// The samples of a tile, pixels along a Z-shaped curve so that any run of them lies close together. The samples of a
    /// pixel follow each other in order.
    pub(super) fn samples(
        &self,
        tile: Region,
        image_height: u32,
        samples: u32,
    ) -> impl Iterator<Item = Sample> {
        let pixels = (0..self.side * self.side).filter_map(move |curve| {
            let (dx, dy) = (every_other_bit(curve), every_other_bit(curve >> 1));
            (dx < tile.width() && dy < tile.height()).then_some((dx, dy))
        });
        pixels.flat_map(move |(dx, dy)| {
            let (x, y) = (tile.x0 + dx, tile.y0 + dy);
            let pixel = dy * tile.width() + dx;
            (0..samples).map(move |s| Sample { x, y, row_from_bottom: image_height - 1 - y, s, pixel })
        })
    }
}

/// Bits 0, 2, 4, … put side by side. Morton, "A Computer Oriented Geodetic Data Base", 1966.
fn every_other_bit(word: u32) -> u32 {
    (0..16).fold(0, |bits, bit| bits | (word >> bit & 1 << bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

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
                for sample in tiles.samples(tile, 100, samples) {
                    assert!(seen.insert((sample.x, sample.y, sample.s)), "{sample:?} came twice");
                    assert_eq!(sample.pixel, (sample.y - tile.y0) * tile.width() + sample.x - tile.x0);
                    let follows =
                        last.is_some_and(|last: Sample| last.pixel == sample.pixel && last.s + 1 == sample.s);
                    assert!(sample.s == 0 || follows, "samples of a pixel stay in order");
                    last = Some(sample);
                }
            }
            assert_eq!(seen.len() as u64, region.pixels() * u64::from(samples));
        }
    }
}
