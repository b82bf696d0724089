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
    let count = level.pending.len();
    let rays = &level.pending.ray[..count];
    for channel in 0..3 {
        let reflected = Children::of(&level.reflected, deeper, channel);
        let refracted = Children::of(&level.refracted, deeper, channel);
        let local_light = &level.pending.light[channel][..count];
        let attenuation = if absorbs { &level.attenuations.attenuation[channel][..count] } else { &[] };
        let radiance = &mut level.radiance.radiance[channel][..];
        for (row, (&ray, &light)) in rays.iter().zip(local_light).enumerate() {
            let mut light = refracted.add_to(row, reflected.add_to(row, light));
            if absorbs {
                light *= attenuation[row];
            }
            radiance[ray as usize] = light;
        }
    }
}

/// What the children of surfaces see, in one channel; empty where there are none.
struct Children<'a> {
    rows: &'a [u32],
    shares: &'a [f32],
    radiance: &'a [f32],
}

impl<'a> Children<'a> {
    fn of(children: &'a ChildQueue, deeper: Option<&'a RadianceQueue>, channel: usize) -> Self {
        let Some(deeper) = deeper else { return Self { rows: &[], shares: &[], radiance: &[] } };
        let count = children.len();
        Self {
            rows: &children.row[..count],
            shares: &children.share[channel][..count],
            radiance: &deeper.radiance[channel],
        }
    }

    /// Adds a surface's child's share of what that sees, where it has a child.
    #[inline(always)]
    fn add_to(&self, row: usize, light: f32) -> f32 {
        match self.rows.get(row) {
            Some(&child) if child != NOTHING => light + self.shares[row] * self.radiance[child as usize],
            _ => light,
        }
    }
}

/// Adds what primary rays see to their pixels. A pixel's samples come in order, in one batch or in several.
pub(super) fn add_to_pixels(samples: &[Sample], radiance: &RadianceQueue, pixels: &mut [[f64; 3]]) {
    for (row, sample) in samples.iter().enumerate() {
        for (sum, column) in pixels[sample.pixel as usize].iter_mut().zip(&radiance.radiance) {
            *sum += f64::from(column[row]);
        }
    }
}
