//! What counts as a hit of a primitive at 0 < t, for one pair of ray and primitive in each lane.
//!
//! A ray that starts on a surface meets that surface again only where geometry says so: a plane never, a sphere once if the
//! ray goes inside. This is known from the event that made the ray, not from the sign of a rounded number. Whatever else
//! touches the surface there, as far as f32 can tell, is met at t = 0, which is no hit. Together they keep a surface from
//! shadowing or reflecting itself without a tolerance that a scene could be too small or too large for.

use crate::kernel::RaySpace;
use crate::kernel::polygon::{self, Outline};
use crate::kernel::sphere::{self, Line};
use crate::kernel::triangle;
use crate::lanes::{Single, Vector};

/// Where a ray starts.
#[derive(Clone, Copy)]
pub(super) struct Start<F: Single> {
    /// On this very primitive.
    pub(super) own: F::Mask,
    /// And goes inside.
    pub(super) inward: F::Mask,
}

#[inline(always)]
pub(super) fn triangle<F: Single, const DEPARTING: bool>(
    space: &RaySpace<F>,
    vertices: [[F; 3]; 3],
    slack: F,
    start: Start<F>,
) -> (F, F::Mask) {
    let zero = F::splat(0.0);
    let meeting = triangle::meet(space, vertices, zero);
    let hit = meeting.inside & meeting.t.gt(zero);
    (meeting.t, if DEPARTING { hit & meeting.volume.abs().gt(slack) & !start.own } else { hit })
}

#[inline(always)]
pub(super) fn sphere<F: Single, const DEPARTING: bool>(
    line: &Line<F>,
    center: Vector<F>,
    radius_squared: F,
    slack: F,
    start: Start<F>,
) -> (F, F::Mask) {
    let zero = F::splat(0.0);
    let meeting = sphere::meet(line, center, radius_squared, zero);
    if !DEPARTING {
        return meeting.nearest(zero);
    }
    let (t, hit) = meeting.nearest_beyond(line, slack);
    let far_side = meeting.far_side();
    let own_hit = start.own & start.inward & far_side.gt(zero);
    (F::select(start.own, far_side, t), own_hit | (!start.own & hit))
}

/// `plane` is a point and the normal; `outline` has taken in all edges.
#[inline(always)]
pub(super) fn polygon<F: Single, const DEPARTING: bool>(
    line: &Line<F>,
    t_per_z: F,
    plane: [Vector<F>; 2],
    outline: &Outline<F>,
    slack: F,
    start: Start<F>,
) -> (F, F::Mask) {
    let zero = F::splat(0.0);
    let corner_ts = [outline.least_z * t_per_z, outline.largest_z * t_per_z];
    let meeting = polygon::meet_plane([line.origin, line.direction], plane, corner_ts, zero);
    let hit = outline.odd & meeting.meets & meeting.t.gt(zero);
    (meeting.t, if DEPARTING { hit & meeting.height.abs().gt(slack) & !start.own } else { hit })
}
