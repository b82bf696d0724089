//! Linear light to the codes of a PNG, by a table of thresholds.
//!
//! Code k stands for the linear values x with floor(srgb(x)·max + ½) = k, so each code begins at the linear value whose
//! sRGB value is (k − ½)/max. Comparing with that table needs no power function at each pixel and gives the same codes
//! everywhere. A second table says which code holds at the f32 with the same leading bits, so that all but a few
//! comparisons are left out. Source of the transfer function: IEC 61966-2-1.

use super::Image;
use crate::math::pow_2_4;
use std::sync::LazyLock;

/// The codes of 8 or of 16 bits.
pub(super) struct Codes {
    /// Entry k − 1 is the smallest f32 of code k; the last is NaN, which no value reaches.
    thresholds: Vec<f32>,
    /// The code of the smallest f32 of every bucket: what has the same bits above the lowest `shift`.
    first: Vec<u16>,
    /// The bits of the smallest f32 of bucket 0, which also takes what is smaller; its code is 0.
    floor: u32,
    shift: u32,
}

impl Codes {
    /// 0–255.
    pub(super) fn of_8_bits() -> &'static Self {
        // Buckets of 7 bits of the mantissa hold no more than one threshold each.
        static CODES: LazyLock<Codes> = LazyLock::new(|| Codes::new(u8::MAX.into(), 7));
        &CODES
    }

    /// 0–65535.
    pub(super) fn of_16_bits() -> &'static Self {
        static CODES: LazyLock<Codes> = LazyLock::new(|| Codes::new(u16::MAX, 12));
        &CODES
    }

    fn new(max_code: u16, mantissa_bits: u32) -> Self {
        let threshold = |code| decode((f64::from(code) - 0.5) / f64::from(max_code));
        let mut thresholds: Vec<f32> = (1..=max_code).map(|code| not_below(threshold(code))).collect();
        let shift = f32::MANTISSA_DIGITS - 1 - mantissa_bits;
        let floor = thresholds.first().map_or(0, |first| first.to_bits() >> shift << shift);
        let code = |bits: u32| thresholds.partition_point(|&threshold| threshold <= f32::from_bits(bits));
        let buckets = 0..=(1.0_f32.to_bits() - floor) >> shift;
        let first = buckets.map(|bucket| code(floor + (bucket << shift)));
        let first = first.map(|code| u16::try_from(code).unwrap_or(u16::MAX)).collect();
        thresholds.push(f32::NAN);
        Self { thresholds, first, floor, shift }
    }

    /// The code of a linear value, clamped; NaN is code 0.
    #[inline]
    pub(super) fn code(&self, linear: f32) -> u16 {
        let bits = if linear > 0.0 { linear.min(1.0).to_bits() } else { 0 };
        let mut code = self.first[(bits.saturating_sub(self.floor) >> self.shift) as usize];
        while self.thresholds[usize::from(code)] <= linear {
            code += 1;
        }
        code
    }
}

/// The smallest f32 that is not below a number.
fn not_below(number: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let rounded = number as f32;
    if f64::from(rounded) < number { rounded.next_up() } else { rounded }
}

/// Turns a picture of sRGB values, 0–1, as a PNG gives it, into one of linear values.
pub fn decode_srgb(image: &mut Image) {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let linear = |encoded: f32| decode(f64::from(encoded)) as f32;
    for pixel in &mut image.pixels {
        *pixel = pixel.map(linear);
    }
}

/// sRGB value, 0–1, to linear.
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { pow_2_4((encoded + 0.055) / 1.055) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The transfer function as the standard writes it, in the direction that the table avoids.
    fn by_formula(linear: f32, max_code: f64) -> f64 {
        let x = f64::from(linear).clamp(0.0, 1.0);
        let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (encoded * max_code + 0.5).floor()
    }

    #[test]
    fn codes_follow_the_transfer_function() {
        for step in -1000_i16..=17_000 {
            let linear = f32::from(step) / 16_000.0;
            for (codes, max_code) in [(Codes::of_8_bits(), 255.0), (Codes::of_16_bits(), 65535.0)] {
                let code = f64::from(codes.code(linear));
                assert_eq!(code, by_formula(linear, max_code), "{linear}, codes up to {max_code}");
            }
        }
    }

    /// Codes grow with the values, so all have the right one if those beside thresholds and edges of buckets have.
    #[test]
    fn codes_begin_at_their_thresholds() {
        for (codes, max_code) in [(Codes::of_8_bits(), u8::MAX.into()), (Codes::of_16_bits(), u16::MAX)] {
            let begins: Vec<f64> =
                (1..=max_code).map(|code| decode((f64::from(code) - 0.5) / f64::from(max_code))).collect();
            let edges = (0..).zip(&codes.first).map(|(bucket, _)| codes.floor + (bucket << codes.shift));
            let edges = edges.map(f32::from_bits).chain(codes.thresholds.iter().copied());
            for value in edges.flat_map(|edge| [edge.next_down(), edge, edge.next_up()]) {
                let expected = begins.partition_point(|&begin| begin <= f64::from(value));
                assert_eq!(usize::from(codes.code(value)), expected, "code of {value}");
            }
        }
    }

    #[test]
    fn values_outside_the_range_are_clamped() {
        for (linear, code) in [
            (-1.0, 0),
            (-0.0, 0),
            (0.0, 0),
            (1.0, 1),
            (7.5, 1),
            (f32::INFINITY, 1),
            (f32::NEG_INFINITY, 0),
            (f32::NAN, 0),
        ] {
            assert_eq!(Codes::of_8_bits().code(linear), code * 255, "8 bits of {linear}");
            assert_eq!(Codes::of_16_bits().code(linear), code * 65535, "16 bits of {linear}");
        }
    }
}
