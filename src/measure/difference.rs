//! How far two pictures lie apart.

use crate::film::Image;
use serde::Serialize;

/// Differences between two pictures of one size, in the values that they hold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The largest difference of a channel; infinite where only one of two values is a number.
    pub largest: f64,
    /// Column and row of the first pixel that has it, counted from the top left.
    pub largest_at: [u32; 2],
    /// Root of the mean of the squared differences of all channels.
    pub rms: f64,
    /// What counts as over the limit; 0 where none is given, so that every difference counts.
    pub limit: f64,
    /// Pixels with a channel that differs by more than the limit.
    pub pixels_over: u64,
}

impl Difference {
    /// Compares two pictures; none if their sizes differ.
    #[must_use]
    pub fn between(a: &Image, b: &Image, limit: f64) -> Option<Self> {
        if (a.width, a.height) != (b.width, b.height) {
            return None;
        }
        let (mut largest, mut largest_at, mut pixels_over, mut squares) = (0.0, 0, 0, 0.0);
        for (index, (a, b)) in a.pixels.iter().zip(&b.pixels).enumerate() {
            let channels = [0, 1, 2].map(|channel| distance(a[channel], b[channel]));
            let pixel = channels.into_iter().fold(0.0, f64::max);
            if pixel > largest {
                (largest, largest_at) = (pixel, index);
            }
            pixels_over += u64::from(pixel > limit);
            squares += channels.into_iter().map(|difference| difference * difference).sum::<f64>();
        }
        let channels = (a.pixels.len() * 3).max(1) as f64;
        let column_and_row = [largest_at % (a.width as usize).max(1), largest_at / (a.width as usize).max(1)];
        Some(Self {
            width: a.width,
            height: a.height,
            largest,
            largest_at: column_and_row.map(|place| u32::try_from(place).unwrap_or(u32::MAX)),
            rms: (squares / channels).sqrt(),
            limit,
            pixels_over,
        })
    }
}

/// Equal infinities and two NaN do not differ; a number and something that is none differ without bound.
fn distance(a: f32, b: f32) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let difference = (f64::from(a) - f64::from(b)).abs();
    if difference.is_nan() { f64::INFINITY } else { difference }
}

/// A picture of where two pictures differ: black for no difference, then red, yellow, and white for the largest one.
#[must_use]
pub fn heat_map(a: &Image, b: &Image, difference: &Difference) -> Image {
    let pixel = |(a, b): (&[f32; 3], &[f32; 3])| {
        let largest =
            [0, 1, 2].map(|channel| distance(a[channel], b[channel])).into_iter().fold(0.0, f64::max);
        let heat = if largest == difference.largest { 1.0 } else { largest / difference.largest };
        if largest == 0.0 { [0.0; 3] } else { glow(heat) }
    };
    let pixels = a.pixels.iter().zip(&b.pixels).map(pixel).collect();
    Image { width: a.width, height: a.height, pixels }
}

/// Red rises first, then green, then blue; the smallest difference is still seen.
fn glow(heat: f64) -> [f32; 3] {
    const FAINTEST: f64 = 0.05;
    let heat = FAINTEST + (1.0 - FAINTEST) * heat;
    [0.0, 1.0, 2.0].map(|channel| {
        #[expect(clippy::cast_possible_truncation, reason = "a colour between 0 and 1")]
        let level = (3.0 * heat - channel).clamp(0.0, 1.0) as f32;
        level
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: &[[f32; 3]]) -> Image {
        Image { width: u32::try_from(pixels.len()).unwrap(), height: 1, pixels: pixels.to_vec() }
    }

    #[test]
    fn measures_are_those_of_the_definition() {
        let a = image(&[[0.0, 0.0, 0.0], [1.0, 0.5, 0.25]]);
        let b = image(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.5]]);
        let difference = Difference::between(&a, &b, 0.25).unwrap();
        assert_eq!((difference.largest, difference.largest_at, difference.pixels_over), (0.5, [1, 0], 1));
        assert_eq!(difference.rms, ((0.25 + 0.0625) / 6.0_f64).sqrt());
        assert_eq!(Difference::between(&a, &b, 0.5).unwrap().pixels_over, 0, "the limit itself is not over");
    }

    #[test]
    fn what_is_no_number_differs_from_every_number() {
        let nan = image(&[[f32::NAN, 0.0, 0.0]]);
        let zero = image(&[[0.0, 0.0, 0.0]]);
        let infinite = image(&[[f32::INFINITY, 0.0, 0.0]]);
        for (a, b, largest) in [
            (&nan, &zero, f64::INFINITY),
            (&nan, &nan, 0.0),
            (&infinite, &infinite, 0.0),
            (&infinite, &nan, f64::INFINITY),
        ] {
            assert_eq!(Difference::between(a, b, 0.0).unwrap().largest, largest);
        }
    }

    #[test]
    fn pictures_of_different_sizes_cannot_be_compared() {
        assert_eq!(Difference::between(&image(&[[0.0; 3]]), &image(&[[0.0; 3]; 2]), 0.0), None);
    }

    #[test]
    fn the_heat_map_is_black_where_nothing_differs_and_white_at_the_largest_difference() {
        let (a, b) = (image(&[[0.0; 3], [0.5; 3], [0.1; 3]]), image(&[[0.0; 3], [1.0; 3], [0.2; 3]]));
        let map = heat_map(&a, &b, &Difference::between(&a, &b, 0.0).unwrap());
        assert_eq!(map.pixels[..2], [[0.0; 3], [1.0; 3]]);
        assert!(
            map.pixels[2][0] > 0.0 && map.pixels[2][1] == 0.0,
            "small differences are red: {:?}",
            map.pixels[2]
        );
    }
}
