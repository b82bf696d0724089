//! What rays hit and which lights their hits saw, kept where it is asked for: a signature of each pixel's tree of rays, or
//! the tree itself.

use super::level::Level;
use super::queue::{ChildQueue, HitQueue, NodeQueue, NormalQueue, ShadowQueue, SurfaceQueue, TrailRecord};
use super::tiles::Sample;
use super::tree;
use crate::prepare::Prepared;
use crate::scene::PrimitiveId;
use crate::signature::{self, Shadow};
use crate::traverse::NOTHING;

/// What a worker keeps of the rays that it traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// What arrives at the eye, and nothing else.
    Colours,
    /// A [`PixelRecord`] of each pixel as well.
    Signatures,
    /// Every ray as well: for a pixel or so.
    Trees,
}

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
pub(super) fn begin(
    prepared: &Prepared<'_>,
    level: &mut Level,
    first_ray: usize,
    hits: &HitQueue,
    surfaces: &SurfaceQueue,
    normals: &NormalQueue,
) {
    for (row, &id) in hits.id[..hits.len()].iter().enumerate() {
        level.nodes.id[first_ray + row] = id;
        level.nodes.node[first_ray + row] = signature::miss();
    }
    level.trails.clear();
    for row in 0..surfaces.len() {
        level.trails.push(TrailRecord { lights: 0, id: surfaces.departure[row] >> 1 });
    }
    tree::begin(prepared, level, first_ray, hits, surfaces, normals);
}

/// What became of one light's question to each surface, with the row of the shadow ray where there is one. Shadow rays come
/// in the order of their surfaces.
pub(super) fn verdicts(shadows: &ShadowQueue, surfaces: usize) -> impl Iterator<Item = (Shadow, usize)> {
    let mut next = 0;
    (0..surfaces).map(move |surface| {
        let row = next;
        let is_traced = row < shadows.len() && shadows.surface[row] as usize == surface;
        next += usize::from(is_traced);
        match is_traced {
            true if shadows.t[row] >= 0.0 => (Shadow::Visible, row),
            true => (Shadow::Hidden, row),
            false => (Shadow::NotTraced, row),
        }
    })
}

/// Notes which surfaces see a light.
pub(super) fn add_light(level: &mut Level, shadows: &ShadowQueue) {
    for (row, (shadow, _)) in verdicts(shadows, level.trails.len()).enumerate() {
        level.trails.lights[row] = signature::with_light(level.trails.lights[row], shadow);
    }
    tree::add_light(level, shadows);
}

/// Folds what the children hit into what their parents hit.
pub(super) fn resolve(level: &mut Level, deeper: Option<&mut Level>) {
    let (deeper, deeper_trees) = deeper.map(|deeper| (&deeper.nodes, deeper.trees.as_mut())).unzip();
    tree::resolve(level, deeper_trees.flatten());
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
