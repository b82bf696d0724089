//! Light on its way back: from children to their parents, and from primary rays to pixels.

use super::level::Level;
use super::queue::{ChildQueue, RadianceQueue};
use super::tiles::Sample;
use crate::traverse::NOTHING;

/// Completes the surfaces of a batch and gives their light to the rays that see them: attenuation · (local light +
/// reflected share · what the reflected ray sees + refracted share · what the refracted ray sees).
///
/// Each sum is over one surface in one order, so it does not depend on which rays were traced together.
pub(super) fn resolve(level: &mut Level, deeper: Option<&RadianceQueue>, absorbs: bool) {
    for row in 0..level.pending.len() {
        let ray = level.pending.ray[row] as usize;
        let reflected = seen(&level.reflected, deeper, row);
        let refracted = seen(&level.refracted, deeper, row);
        for channel in 0..3 {
            let mut light = level.pending.light[channel][row];
            for (share, radiance) in [reflected, refracted].into_iter().flatten() {
                light += share[channel] * radiance[channel];
            }
            if absorbs {
                light *= level.attenuations.attenuation[channel][row];
            }
            level.radiance.radiance[channel][ray] = light;
        }
    }
}

/// The share and the radiance of a surface's child, if it has one.
#[inline(always)]
fn seen(children: &ChildQueue, deeper: Option<&RadianceQueue>, row: usize) -> Option<([f32; 3], [f32; 3])> {
    let deeper = deeper.filter(|_| children.len() > 0)?;
    let child = children.row[row];
    (child != NOTHING).then(|| {
        let share = [0, 1, 2].map(|channel| children.share[channel][row]);
        (share, [0, 1, 2].map(|channel| deeper.radiance[channel][child as usize]))
    })
}

/// Adds what primary rays see to their pixels. A pixel's samples come in order, in one batch or in several.
pub(super) fn add_to_pixels(samples: &[Sample], radiance: &RadianceQueue, pixels: &mut [[f64; 3]]) {
    for (row, sample) in samples.iter().enumerate() {
        for (sum, column) in pixels[sample.pixel as usize].iter_mut().zip(&radiance.radiance) {
            *sum += f64::from(column[row]);
        }
    }
}
