//! Recorded rays: an NPY array of shape (R, 8), f32: origin xyz, tmin, direction xyz, tmax.

use super::error::{InputError, Place};
use super::text::read_bytes;
use crate::npy;
use crate::rays::RaySet;
use std::path::Path;

/// Reads recorded rays.
///
/// # Errors
/// A file that cannot be opened, is no such array, or has no rays in it.
pub fn rays(path: &Path) -> Result<RaySet, InputError> {
    let refused = |message: String| InputError::refused(path, Place::File, message);
    let bytes = read_bytes(path)?;
    let array = npy::read::<f32>(&bytes).map_err(refused)?;
    let rows = array
        .rows::<8>()
        .map_err(|why| refused(format!("{why}: origin xyz, tmin, direction xyz and tmax of each ray")))?;
    if rows.is_empty() {
        return Err(refused(
            "there are no rays in it; record some with `wavelane render --record-rays`".into(),
        ));
    }
    Ok(RaySet { rows: rows.to_vec(), ..RaySet::default() })
}
