//! Linear light to the codes of a PNG, by a table of thresholds.
//!
//! Code k stands for the linear values x with floor(srgb(x)·max + ½) = k, so each code begins at the linear value whose
//! sRGB value is (k − ½)/max. Comparing with that table needs no power function at each pixel and gives the same codes
//! everywhere. Source of the transfer function: IEC 61966-2-1.

use super::Image;
use crate::math::pow_2_4;
use std::sync::LazyLock;

/// Entry k − 1 is where code k begins.
struct Thresholds(Vec<f64>);

impl Thresholds {
    fn new(max_code: u32) -> Self {
        Self((1..=max_code).map(|code| decode((f64::from(code) - 0.5) / f64::from(max_code))).collect())
    }

    /// NaN is code 0.
    fn code(&self, linear: f32) -> usize {
        self.0.partition_point(|&threshold| threshold <= f64::from(linear))
    }
}

/// The code of a linear value, clamped to 0–255.
pub(super) fn code_8(linear: f32) -> u8 {
    static THRESHOLDS: LazyLock<Thresholds> = LazyLock::new(|| Thresholds::new(u32::from(u8::MAX)));
    u8::try_from(THRESHOLDS.code(linear)).unwrap_or(u8::MAX)
}

/// The code of a linear value, clamped to 0–65535.
pub(super) fn code_16(linear: f32) -> u16 {
    static THRESHOLDS: LazyLock<Thresholds> = LazyLock::new(|| Thresholds::new(u32::from(u16::MAX)));
    u16::try_from(THRESHOLDS.code(linear)).unwrap_or(u16::MAX)
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
            assert_eq!(f64::from(code_8(linear)), by_formula(linear, 255.0), "8 bits of {linear}");
            assert_eq!(f64::from(code_16(linear)), by_formula(linear, 65535.0), "16 bits of {linear}");
        }
    }

    #[test]
    fn values_outside_the_range_are_clamped() {
        for (linear, code) in [
            (-1.0, 0),
            (0.0, 0),
            (1.0, 255),
            (7.5, 255),
            (f32::INFINITY, 255),
            (f32::NEG_INFINITY, 0),
            (f32::NAN, 0),
        ] {
            assert_eq!(code_8(linear), code, "code of {linear}");
        }
    }
}
