//! What rays hit and which lights their hits saw, kept where it is asked for: a signature of each pixel's tree of rays.

use super::level::Level;
use super::queue::{ChildQueue, HitQueue, NodeQueue, ShadowQueue, SurfaceQueue, TrailRecord};
use super::tiles::Sample;
use crate::scene::PrimitiveId;
use crate::signature::{self, Shadow};
use crate::traverse::NOTHING;

/// What is known of a pixel beside its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRecord {
    /// Tells one tree of rays from another: which primitive each ray of the pixel hit, and which lights each hit saw.
    pub signature: u64,
    /// What the primary ray of the first sample hit; none on a miss.
    pub primary: Option<PrimitiveId>,
}

impl PixelRecord {
    pub(crate) const NONE: Self = Self { signature: 0, primary: None };
}

/// Notes what a batch of rays hit, and begins a trail for each surface.
pub(super) fn begin(level: &mut Level, first_ray: usize, hits: &HitQueue, surfaces: &SurfaceQueue) {
    for (row, &id) in hits.id[..hits.len()].iter().enumerate() {
        level.nodes.id[first_ray + row] = id;
        level.nodes.node[first_ray + row] = signature::miss();
    }
    level.trails.clear();
    for row in 0..surfaces.len() {
        level.trails.push(TrailRecord { lights: 0, id: surfaces.departure[row] >> 1 });
    }
}

/// Notes which surfaces see a light. Shadow rays come in the order of their surfaces.
pub(super) fn add_light(level: &mut Level, shadows: &ShadowQueue) {
    let mut next = 0;
    for row in 0..level.trails.len() {
        let is_traced = next < shadows.len() && shadows.surface[next] as usize == row;
        let shadow = match is_traced {
            true if shadows.t[next] >= 0.0 => Shadow::Visible,
            true => Shadow::Hidden,
            false => Shadow::NotTraced,
        };
        next += usize::from(is_traced);
        level.trails.lights[row] = signature::with_light(level.trails.lights[row], shadow);
    }
}

/// Folds what the children hit into what their parents hit.
pub(super) fn resolve(level: &mut Level, deeper: Option<&NodeQueue>) {
    for row in 0..level.trails.len() {
        let node_of = |children: &ChildQueue| match deeper.filter(|_| children.len() > 0) {
            Some(deeper) if children.row[row] != NOTHING => deeper.node[children.row[row] as usize],
            _ => 0,
        };
        let (reflected, refracted) = (node_of(&level.reflected), node_of(&level.refracted));
        let id = PrimitiveId(level.trails.id[row]);
        let ray = level.pending.ray[row] as usize;
        level.nodes.node[ray] = signature::hit(id, level.trails.lights[row], reflected, refracted);
    }
}

/// Folds primary rays into their pixels' records, in order of the samples.
pub(super) fn add_to_pixels(samples: &[Sample], nodes: &NodeQueue, pixels: &mut [PixelRecord]) {
    for (row, sample) in samples.iter().enumerate() {
        let pixel = &mut pixels[sample.pixel as usize];
        pixel.signature = signature::with_sample(pixel.signature, nodes.node[row]);
        if sample.s == 0 {
            let id = nodes.id[row];
            pixel.primary = (id != NOTHING).then_some(PrimitiveId(id));
        }
    }
}
