//! What a number of a scene may be, and its one rounding to f32.

use crate::scene::MAX_COORDINATE;
use glam::{DVec3, Vec3};

/// Refuses what no scene can use.
pub(super) fn check(value: f64) -> Result<f64, String> {
    if value.is_nan() {
        Err("a number must be finite; this one is NaN".to_owned())
    } else if value.is_infinite() {
        Err("a number must be finite; this one is infinite".to_owned())
    } else if value.abs() > MAX_COORDINATE {
        Err(format!("a number must be at most 1e18 in magnitude; this one is {value:e}"))
    } else {
        Ok(value)
    }
}

/// Parses and checks a word.
pub(super) fn parse(word: &str) -> Result<f64, String> {
    match word.parse() {
        Ok(value) => check(value),
        Err(_) => Err(format!("expected a number, found `{}`", shortened(word))),
    }
}

/// The one rounding to f32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is what is meant; magnitudes are at most 1e18"
)]
pub(super) fn rounded(value: f64) -> f32 {
    value as f32
}

/// Likewise.
pub(super) fn rounded_3(value: DVec3) -> Vec3 {
    value.as_vec3()
}

/// A word as a message can show it.
pub(super) fn shortened(word: &str) -> String {
    const LONGEST: usize = 32;
    let shown: String = word.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if word.chars().nth(LONGEST).is_some() { format!("{shown}…") } else { shown }
}
