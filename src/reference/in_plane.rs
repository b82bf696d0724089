//! Faces that a ray sees edge-on.
//!
//! A plane seen edge-on is met anywhere, but a face in it is where its edges next to the ray's foot are: see
//! [`kept_between_edges`].
//!
//! A ray that starts beside a face, within its plane or nearly so, and goes along the plane sees the face edge-on: where it
//! meets the plane is nothing but rounding, and a concave face may lie both before the start and behind it. What tells is the
//! part of the face that lies before: its outline, closed by the line along which the start's own cross-section cuts it. The
//! start is not on that line, or it would be on the face.

use super::ray::Ray;
use super::shape::{cross, crosses};
use glam::DVec3;

/// What a ray meets of a face that has vertices on both sides of `t_min`.
pub(super) enum Part {
    /// The start is on the face, or as near as rounding can tell.
    StartsOn,
    /// About where the edges there have this t: better known only where the ray meets the plane beyond `t_min`.
    Met(f64),
    Passed,
}

/// The part of a face that lies beyond `t_min`, for a ray that starts in the face's plane; seen along the ray. What is no farther
/// than `slack`, a length, from the start is at the start.
///
/// The edges beyond `t_min` are asked just what neighbours ask of them (`crosses`), and every point is above the foot or below
/// it for both lines that end there. So however points are rounded, the lines are closed, and no ray slips between a face that
/// is cut so and its neighbour.
pub(super) fn part_beyond(ray: &Ray, vertices: &[DVec3], slack: f64) -> Part {
    let slack_t = slack / ray.direction.abs().max_element();
    let t_min = ray.t_min + slack_t;
    let mut is_in = false;
    // Distance from the foot, and t.
    let mut nearest = (f64::INFINITY, t_min);
    // Where the outline passes t_min, and whether that is below the foot.
    let mut cuts: Vec<(DVec3, bool)> = Vec::new();
    let mut from = ray.project(vertices[vertices.len() - 1]);
    for &vertex in vertices {
        let to = ray.project(vertex);
        let is_below = [from, to].map(|end| end.y < 0.0);
        let is_beyond = [from, to].map(|end| end.z > t_min);
        let mut changes_side = is_below[0] != is_below[1];
        if is_beyond[0] != is_beyond[1] {
            let cut = from.lerp(to, ((from.z - ray.t_min) / (from.z - to.z)).clamp(0.0, 1.0));
            let is_cut_below = if changes_side { cut.y < 0.0 } else { is_below[0] };
            changes_side = is_cut_below != is_below[usize::from(is_beyond[1])];
            cuts.push((cut, is_cut_below));
        } else {
            changes_side &= is_beyond[0];
        }
        if changes_side {
            is_in ^= crosses(from, to);
            let at = level_with_foot(from, to);
            if at.x.abs() < nearest.0 {
                nearest = (at.x.abs(), at.z);
            }
        }
        from = to;
    }
    // All of it is at the start or behind: that lies across the ray, and its plane says more than its corners.
    let end = vertices.iter().map(|&vertex| ray.project(vertex).z).fold(f64::NEG_INFINITY, f64::max);
    if end <= t_min && end >= ray.t_min - slack_t {
        return Part::StartsOn;
    }
    // The cuts are on a line. Along it, inside is between the first and the second, the third and the fourth.
    let spread = |axis: usize| {
        let along = || cuts.iter().map(|(cut, _)| cut[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let axis = usize::from(spread(1) > spread(0));
    cuts.sort_by(|one, other| one.0[axis].total_cmp(&other.0[axis]));
    for pair in cuts.chunks_exact(2) {
        let [(one, is_one_below), (other, is_other_below)] = [pair[0], pair[1]];
        if one[axis] <= slack && other[axis] >= -slack {
            return Part::StartsOn;
        }
        if is_one_below != is_other_below {
            let (lower, upper) = if is_one_below { (one, other) } else { (other, one) };
            is_in ^= cross(lower, upper) > 0.0;
        }
    }
    if !is_in {
        return Part::Passed;
    }
    Part::Met(nearest.1)
}

/// t, moved to between the nearest edges that the line through the ray's foot along x meets, to the left and to the right. The foot
/// is inside.
pub(super) fn kept_between_edges(ray: &Ray, vertices: &[DVec3], t: f64) -> f64 {
    // Distance from the foot, and t.
    let (mut left, mut right) = ((f64::INFINITY, t), (f64::INFINITY, t));
    let mut from = ray.project(vertices[vertices.len() - 1]);
    for &vertex in vertices {
        let to = ray.project(vertex);
        if (from.y < 0.0) != (to.y < 0.0) {
            let at = level_with_foot(from, to);
            let side = if crosses(from, to) { &mut right } else { &mut left };
            if at.x.abs() < side.0 {
                *side = (at.x.abs(), at.z);
            }
        }
        from = to;
    }
    t.clamp(left.1.min(right.1), left.1.max(right.1))
}

/// The point of an edge from below the foot to above it, or back, that is level with it.
fn level_with_foot(from: DVec3, to: DVec3) -> DVec3 {
    from.lerp(to, from.y / (from.y - to.y))
}
