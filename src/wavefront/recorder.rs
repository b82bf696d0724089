//! The rays of a frame and what they hit, kept where that is asked for.

use super::level::Level;
use super::queue::{HitQueue, NormalQueue, ShadowQueue, SurfaceQueue};
use crate::prepare::{Prepared, Scale};
use crate::rays::{Departure, Found, RayKind, RecordedRays, Start};
use crate::scene::PrimitiveId;
use crate::traverse::NOTHING;

/// Copies rays out of the queues, into world space: the scene's scale is a power of two, so this leaves their bits as they
/// are.
pub(super) struct Recorder {
    scale: Scale,
    pub(super) rays: RecordedRays,
}

impl Recorder {
    pub(super) fn new(prepared: &Prepared<'_>) -> Self {
        Self { scale: prepared.scale, rays: RecordedRays::default() }
    }

    /// Keeps a batch of a level's rays, once their surfaces are known.
    pub(super) fn closest(
        &mut self,
        (level, depth, first): (&Level, usize, usize),
        hits: &HitQueue,
        surfaces: &SurfaceQueue,
        normals: &NormalQueue,
    ) {
        let world = 1.0 / self.scale.factor();
        let begin = RayKind::ALL.map(|kind| self.rays.of(kind).len());
        for hit in 0..hits.len() {
            let row = first + hit;
            let kind = match depth {
                0 => RayKind::Primary,
                _ if row < level.reflected_rays => RayKind::Reflect,
                _ => RayKind::Refract,
            };
            let [ox, oy, oz] = [0, 1, 2].map(|axis| level.rays.origin[axis][row] * world);
            let [dx, dy, dz] = [0, 1, 2].map(|axis| level.rays.direction[axis][row]);
            let set = self.rays.of_mut(kind);
            set.rows.push([ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]);
            let id = hits.id[hit];
            set.found.push(Found {
                t: hits.t[hit] * world,
                id: (id != NOTHING).then_some(PrimitiveId(id)),
                shading_normal: [0.0; 3],
            });
            if depth > 0 {
                let low = [0, 1, 2].map(|axis| level.departures.origin_low[axis][row] * world);
                set.starts.push(start(low, level.departures.departure[row]));
            }
        }
        for surface in 0..surfaces.len() {
            let row = surfaces.ray[surface] as usize;
            let (kind, hit) = match depth {
                0 => (RayKind::Primary, row - first),
                _ if row < level.reflected_rays => (RayKind::Reflect, row - first),
                _ => (RayKind::Refract, row - level.reflected_rays.max(first)),
            };
            let columns =
                if normals.len() > 0 { &normals.shading_normal } else { &surfaces.geometric_normal };
            self.rays.of_mut(kind).found[begin[kind as usize] + hit].shading_normal =
                [0, 1, 2].map(|axis| columns[axis][surface]);
        }
    }

    /// Keeps the shadow rays of a light, before they are traced.
    pub(super) fn shadow(&mut self, shadows: &ShadowQueue) {
        let world = 1.0 / self.scale.factor();
        let set = self.rays.of_mut(RayKind::Shadow);
        for row in 0..shadows.len() {
            let [ox, oy, oz] = [0, 1, 2].map(|axis| shadows.origin[axis][row] * world);
            // A direction that leads all the way to the light, which is at t = 1 then.
            let end = shadows.t[row];
            let (length, t_max) = if end == f32::INFINITY { (1.0, end) } else { (end * world, 1.0) };
            let [dx, dy, dz] = [0, 1, 2].map(|axis| shadows.direction[axis][row] * length);
            set.rows.push([ox, oy, oz, 0.0, dx, dy, dz, t_max]);
            let low = [0, 1, 2].map(|axis| shadows.origin_low[axis][row] * world);
            set.starts.push(start(low, shadows.departure[row]));
        }
    }
}

fn start(origin_low: [f32; 3], departure: u32) -> Start {
    Start {
        origin_low,
        departure: Departure { from: PrimitiveId(departure >> 1), inward: departure & 1 == 1 },
    }
}
