//! What counts as a hit of a primitive, for one pair of ray and primitive in each lane.
//!
//! A ray that starts on a surface meets that surface again only where geometry says so: a plane never, a sphere once if the
//! ray goes inside. This is known from the event that made the ray, not from the sign of a rounded number. Where a ray starts
//! so near to another surface that f32 cannot tell on which side of it, `exact` decides in f64.
//!
//! A ray that starts on a surface passes the edges of its neighbours closely, and must neither hit one that it rises above nor
//! slip between two that it falls on. So for such rays the tests take the whole start, with what its rounding left out, and
//! `exact` also decides wherever the foot of the ray is so near to an edge that f32 cannot tell on which side. What f32 decides
//! is then what f64 would. Together they keep a surface from shadowing or reflecting itself or its neighbours, without a
//! tolerance that a scene could be too small or too large for.
//!
//! For a ray from the eye there is nothing to be taken for the surface that it leaves. It only has to find one of two faces at
//! an edge and not the other, which the kernels see to in f32.

use crate::kernel::polygon::{self, Outline};
use crate::kernel::sphere::{self, Line};
use crate::kernel::triangle;
use crate::kernel::{RaySpace, UNIT_ROUNDOFF};
use crate::lanes::{Mask, Single, Vector};
use crate::prepare::TOUCHING_OF_UNIT_SPHERE;

/// Where a ray starts.
#[derive(Clone, Copy)]
pub(super) struct Start<F: Single> {
    /// On this very primitive.
    pub(super) own: F::Mask,
    /// And goes inside.
    pub(super) inward: F::Mask,
    /// Hits are wanted beyond this t; 0 for a ray that starts on a primitive.
    pub(super) t_min: F,
}

/// A hit of a primitive, in each lane. Where it is said that there is none, no lane that is asked for hits or is unclear; of
/// lanes that are not asked for nothing is said.
#[derive(Clone, Copy)]
pub(super) struct Candidate<F: Single> {
    pub(super) t: F,
    /// How far t may be from the true one, at most.
    pub(super) error: F,
    pub(super) hit: F::Mask,
    /// Lanes in which f32 cannot tell: `exact` decides, and `hit` is false.
    pub(super) unclear: F::Mask,
}

/// Ray space, the line, and how far a surface may seem to be from where it is: `bounds::PADDING` of the coordinates that
/// take part, more than any kernel's own rounding.
#[derive(Clone, Copy)]
pub(super) struct View<F: Single> {
    pub(super) space: RaySpace<F>,
    pub(super) line: Line<F>,
    pub(super) padding: F,
}

#[inline(always)]
pub(super) fn triangle<F: Single, const DEPARTING: bool>(
    space: &RaySpace<F>,
    padding: F,
    vertices: [[F; 3]; 3],
    sizes: impl FnOnce() -> [F; 2],
    (asked, start): (F::Mask, Start<F>),
) -> Option<Candidate<F>> {
    let zero = F::splat(0.0);
    let meeting = triangle::meet(space, vertices);
    if !DEPARTING && !(meeting.is_inside_or_tied(zero) & asked).any() {
        return None;
    }
    let [size, error_area] = sizes();
    let asked = asked & !start.own;
    let (may_be_inside, inside) = if DEPARTING {
        let (may_be, is) = meeting.may_be_inside(size);
        (may_be & asked, is & asked)
    } else {
        let inside = meeting.inside(zero) & asked;
        (inside, inside)
    };
    if DEPARTING && !may_be_inside.any() {
        return None;
    }
    let touches = meeting.touches(size);
    let t = meeting.t(space);
    let hit = inside & !touches & t.gt(start.t_min);
    let unclear = may_be_inside & (touches | !inside);
    // cos θ·|d| = |seen area·d_z| / area. Seen so nearly edge-on that the area may be nothing but rounding, t may be anything.
    let error = padding * error_area * space.t_per_z.abs() / meeting.least_seen_area(padding, zero);
    Some(Candidate { t, error, hit, unclear })
}

#[inline(always)]
pub(super) fn sphere<F: Single, const DEPARTING: bool>(
    line: &Line<F>,
    padding: F,
    center: Vector<F>,
    radius: F,
    (asked, start): (F::Mask, Start<F>),
) -> Option<Candidate<F>> {
    let zero = F::splat(0.0);
    let radius_squared = radius * radius;
    let meeting = sphere::meet(line, center, radius_squared, zero);
    if !((meeting.meets | start.own) & asked).any() {
        return None;
    }
    // cos θ·|d| = half the chord·a / r; half the chord is off by at most twice what that makes of its distance.
    let error = (padding + padding) * radius / (meeting.half_t * line.a);
    let (t, hit) = meeting.nearest(start.t_min);
    let touches = meeting.touches(line, F::splat(TOUCHING_OF_UNIT_SPHERE) * radius_squared);
    if !DEPARTING {
        return Some(Candidate { t, error, hit: hit & !touches, unclear: touches });
    }
    let touches = touches & !start.own;
    let far_side = meeting.far_side();
    let own_hit = start.own & start.inward & far_side.gt(zero);
    let hit = own_hit | (!start.own & !touches & hit);
    Some(Candidate { t: F::select(start.own, far_side, t), error, hit, unclear: touches })
}

/// `plane` is a point and the normal; `outline` has taken in all edges.
#[inline(always)]
pub(super) fn polygon<F: Single, const DEPARTING: bool>(
    view: &View<F>,
    plane: [Vector<F>; 2],
    outline: &Outline<F>,
    slack: F,
    start: Start<F>,
) -> Candidate<F> {
    let zero = F::splat(0.0);
    let corner_ts = [outline.least_z * view.space.t_per_z, outline.largest_z * view.space.t_per_z];
    let meeting = polygon::meet_plane(&view.line, plane, corner_ts, zero);
    let touches = !meeting.height.abs().gt(slack);
    let is_beyond = meeting.meets & meeting.t.gt(start.t_min);
    // Of the slope too, some roundings are not to be relied on.
    let slope = (meeting.slope.abs() - F::splat(8.0 * UNIT_ROUNDOFF) * view.line.a).max(zero);
    let error = view.padding / slope;
    if DEPARTING {
        let hit = outline.odd & !outline.unclear & !touches & is_beyond & !start.own;
        let unclear = (outline.unclear | (outline.odd & touches)) & !start.own;
        return Candidate { t: meeting.t, error, hit, unclear };
    }
    // Of a start in the plane it is not said that the foot is inside if the ray meets the polygon: of a concave one it may see
    // two parts, one before it and one behind.
    let unclear = (outline.odd | outline.unclear) & touches;
    Candidate { t: meeting.t, error, hit: outline.odd & !touches & is_beyond, unclear }
}
