//! A picture in memory, and a rectangle of one.

use rayon::prelude::*;
use std::collections::TryReserveError;

/// A rectangle of pixels, counted from the full image's top left, half open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Leftmost column.
    pub x0: u32,
    /// Topmost row.
    pub y0: u32,
    /// The column after the last.
    pub x1: u32,
    /// The row after the last.
    pub y1: u32,
}

impl Region {
    /// All of an image.
    #[must_use]
    pub fn whole(width: u32, height: u32) -> Self {
        Self { x0: 0, y0: 0, x1: width, y1: height }
    }

    /// Whether it has pixels and all of them lie in an image of this size.
    #[must_use]
    pub fn fits(&self, width: u32, height: u32) -> bool {
        self.x0 < self.x1 && self.y0 < self.y1 && self.x1 <= width && self.y1 <= height
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.x1 - self.x0
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.y1 - self.y0
    }

    /// Columns times rows.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        u64::from(self.width()) * u64::from(self.height())
    }
}

/// Pixels in linear RGB, row by row from the top, not clamped.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` of them.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A black picture as large as a region. The system hands over its pages as they are first written to,
    /// which takes time: all threads of the pool that it is called in share in it.
    ///
    /// # Errors
    /// There is not that much memory.
    pub fn black(region: &Region) -> Result<Self, TryReserveError> {
        let count = usize::try_from(region.pixels()).unwrap_or(usize::MAX);
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count)?;
        pixels.par_extend(rayon::iter::repeat_n([0.0; 3], count));
        Ok(Self { width: region.width(), height: region.height(), pixels })
    }

    /// Where a pixel is kept.
    #[must_use]
    pub fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }
}
