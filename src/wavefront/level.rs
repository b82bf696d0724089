//! The queues of one depth.

use super::queue::{
    AttenuationQueue, ChildQueue, DepartureQueue, NodeQueue, PendingQueue, QueuePlan, RadianceQueue,
    RayQueue, TrailQueue,
};
use super::trail::Keep;
use super::tree::Trees;
use crate::prepare::Plan;

/// Rays of one depth, what they see, and the surfaces of the batch of them whose children are being traced.
///
/// These queues live on while deeper levels are worked through; everything else is shared by all depths.
pub(super) struct Level {
    pub(super) rays: RayQueue,
    /// How many of the rays, the first ones, were reflected; the others were refracted.
    pub(super) reflected_rays: usize,
    /// Row by row of the rays; empty at depth 0.
    pub(super) departures: DepartureQueue,
    /// Row by row of the rays.
    pub(super) radiance: RadianceQueue,
    /// Row by row of the batch's surfaces, as all that follow.
    pub(super) pending: PendingQueue,
    pub(super) attenuations: AttenuationQueue,
    pub(super) reflected: ChildQueue,
    pub(super) refracted: ChildQueue,
    /// Row by row of the rays; empty unless a record is asked for.
    pub(super) nodes: NodeQueue,
    /// Row by row of the batch's surfaces; likewise.
    pub(super) trails: TrailQueue,
    /// Row by row of the rays; none unless asked for.
    pub(super) trees: Option<Trees>,
}

impl Level {
    /// Room for the children of a batch, or for a batch of primary rays at depth 0.
    pub(super) fn new(plan: &Plan, depth: u32, batch: usize, keep: Keep) -> Self {
        let records = keep != Keep::Colours;
        let rays = if depth == 0 {
            batch
        } else {
            batch * (usize::from(plan.reflection) + usize::from(plan.refraction))
        };
        let if_needed = |is_needed: bool, rows: usize| if is_needed { rows } else { 0 };
        let has_children = depth < plan.max_depth;
        let has_surfaces = plan.spheres + plan.triangles + plan.polygons > 0;
        Self {
            rays: RayQueue::with_capacity(rays),
            reflected_rays: 0,
            departures: DepartureQueue::with_capacity(if_needed(depth > 0, rays)),
            radiance: RadianceQueue::with_capacity(rays),
            pending: PendingQueue::with_capacity(if_needed(has_surfaces, batch)),
            attenuations: AttenuationQueue::with_capacity(if_needed(plan.absorption, batch)),
            reflected: ChildQueue::with_capacity(if_needed(plan.reflection && has_children, batch)),
            refracted: ChildQueue::with_capacity(if_needed(plan.refraction && has_children, batch)),
            nodes: NodeQueue::with_capacity(if_needed(records, rays)),
            trails: TrailQueue::with_capacity(if_needed(records && has_surfaces, batch)),
            trees: (keep == Keep::Trees).then(Vec::new),
        }
    }

    /// Empties the rays, for their parents to fill.
    pub(super) fn begin(&mut self) {
        self.rays.clear();
        self.reflected_rays = 0;
        self.departures.clear();
    }

    pub(super) fn queues(&self) -> [QueuePlan; 9] {
        [
            self.rays.plan(),
            self.departures.plan(),
            self.radiance.plan(),
            self.pending.plan(),
            self.attenuations.plan(),
            self.reflected.plan(),
            self.refracted.plan(),
            self.nodes.plan(),
            self.trails.plan(),
        ]
    }

    pub(super) fn bytes(&self) -> usize {
        self.queues().iter().map(|queue| queue.bytes).sum()
    }
}
