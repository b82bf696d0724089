//! Faces whose plane a ray starts in.
//!
//! A ray that starts beside a face, within its plane or nearly so, and goes along the plane sees the face edge-on: where it
//! meets the plane is nothing but rounding, and a concave face may lie both before the start and behind it. What tells is the
//! part of the face that lies before: its outline, closed by the line along which the start's own cross-section cuts it. The
//! start is not on that line, or it would be on the face.

use crate::kernel::{RaySpace, Seen, axes_along, cross, crosses};
use crate::lanes::Lanes;
use glam::{DVec2, DVec3};

/// A face as seen along a ray.
pub(super) struct Outline {
    corners: Vec<Corner>,
    /// Along the axis in which the ray is fastest.
    t_per_length: f64,
}

/// What the kernels see, and the same in f64 with t for the third coordinate.
struct Corner {
    seen: Seen<f32>,
    at: DVec3,
}

/// What a ray meets of a face in whose plane it starts, as far as f32 can tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    /// The start is on the face, or as near as rounding can tell.
    StartsOn,
    /// About where the edges there have this t: better known only where the ray meets the plane beyond its start.
    Met(f64),
    Passed,
}

impl Outline {
    /// The ray is one of f32.
    pub(super) fn new(origin: DVec3, direction: DVec3, corners: &[DVec3]) -> Self {
        let [origin_f32, direction_f32] = [origin, direction].map(|vector| vector.as_vec3().to_array());
        let axes @ [x, y, z] = axes_along(direction_f32);
        let t_per_z = 1.0 / direction_f32[z];
        let space = RaySpace {
            origin: axes.map(|axis| origin_f32[axis]),
            origin_low: None,
            shear: [direction_f32[x] * t_per_z, direction_f32[y] * t_per_z],
            t_per_z,
        };
        let see = |&corner: &DVec3| {
            let from_origin = corner - origin;
            let t = from_origin[z] / direction[z];
            let at = from_origin - direction * t;
            let corner = corner.as_vec3();
            Corner { seen: space.see(axes.map(|axis| corner[axis])), at: DVec3::new(at[x], at[y], t) }
        };
        Self { corners: corners.iter().map(see).collect(), t_per_length: direction[z].abs().recip() }
    }

    fn edges(&self) -> impl Iterator<Item = (&Corner, &Corner)> {
        self.corners.iter().zip(self.corners.iter().cycle().skip(1))
    }

    /// Whether the ray's foot is inside, as the kernels decide it.
    pub(super) fn is_foot_inside(&self) -> bool {
        self.edges().filter(|(from, to)| is_crossed(from, to)).count() % 2 == 1
    }

    /// What lies beyond a t of a face in whose plane the ray starts there. What is no farther than `slack`, a length, from
    /// the start is at the start.
    ///
    /// The edges there are asked just what the kernels ask of them, and every point is above the foot or below it for both lines
    /// that end there. So however points are rounded, the lines are closed, and no ray slips between a face that is cut so and
    /// its neighbour.
    pub(super) fn part_beyond(&self, start_t: f64, slack: f64) -> Part {
        let slack_t = slack * self.t_per_length;
        let t_min = start_t + slack_t;
        let mut is_in = false;
        // Distance from the foot, and t.
        let mut nearest = (f64::INFINITY, t_min);
        let mut cuts: Vec<Cut> = Vec::new();
        for (from, to) in self.edges() {
            let is_below = [from, to].map(|end| end.seen.y < 0.0);
            let is_beyond = [from, to].map(|end| end.at.z > t_min);
            let mut changes_side = is_below[0] != is_below[1];
            if is_beyond[0] != is_beyond[1] {
                let cut = Cut::new(from, to, kept_on_edge((from.at.z - start_t) / (from.at.z - to.at.z)));
                changes_side = cut.is_below != is_below[usize::from(is_beyond[1])];
                cuts.push(cut);
            } else {
                changes_side &= is_beyond[0];
            }
            if changes_side {
                is_in ^= is_crossed(from, to);
                let at = level_with_foot(from.at, to.at);
                if at.x.abs() < nearest.0 {
                    nearest = (at.x.abs(), at.z);
                }
            }
        }
        // All of it is at the start or behind: that lies across the ray, and its plane says more than its corners.
        let end = self.corners.iter().map(|corner| corner.at.z).fold(f64::NEG_INFINITY, Lanes::max);
        if end <= t_min && end >= start_t - slack_t {
            return Part::StartsOn;
        }
        match is_in_by_cuts(cuts, slack) {
            None => Part::StartsOn,
            Some(is_in_by_cuts) if is_in_by_cuts == is_in => Part::Passed,
            Some(_) => Part::Met(nearest.1),
        }
    }
}

fn is_crossed(from: &Corner, to: &Corner) -> bool {
    crosses(&from.seen, &to.seen, cross(&from.seen, &to.seen), 0.0)
}

/// Where an edge passes the t at which the ray starts.
struct Cut {
    at: DVec2,
    /// By what f32 has made of the edge's ends, which is what its neighbour has, too.
    seen: DVec2,
    is_below: bool,
}

impl Cut {
    fn new(from: &Corner, to: &Corner, share: f64) -> Self {
        let [seen_from, seen_to] =
            [from, to].map(|end| DVec2::new(f64::from(end.seen.x), f64::from(end.seen.y)));
        let seen = seen_from.lerp(seen_to, share);
        let is_below = match [seen_from, seen_to].map(|end| end.y < 0.0) {
            [true, true] => true,
            [false, false] => false,
            _ => seen.y < 0.0,
        };
        Self { at: from.at.lerp(to.at, share).truncate(), seen, is_below }
    }
}

/// Whether the lines between cuts cross the half-line from the foot along x an odd number of times; none if the start is on
/// one of them.
fn is_in_by_cuts(mut cuts: Vec<Cut>, slack: f64) -> Option<bool> {
    let (low, high) = cuts
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), cut| (low.min(cut.at), high.max(cut.at)));
    // They are on a line. Along it, inside is between the first and the second, the third and the fourth.
    let axis = usize::from((high - low).y > (high - low).x);
    cuts.sort_by(|one, other| one.at[axis].total_cmp(&other.at[axis]));
    let mut is_in = false;
    for pair in cuts.chunks_exact(2) {
        let [one, other] = [&pair[0], &pair[1]];
        if one.at[axis] <= slack && other.at[axis] >= -slack {
            return None;
        }
        if one.is_below != other.is_below {
            let (lower, upper) = if one.is_below { (one, other) } else { (other, one) };
            is_in ^= lower.seen.perp_dot(upper.seen) > 0.0;
        }
    }
    Some(is_in)
}

/// The point of an edge that is level with the foot; f32 has found that there is one.
fn level_with_foot(from: DVec3, to: DVec3) -> DVec3 {
    // Where f64 finds none it would be outside of the edge, or no number.
    from.lerp(to, kept_on_edge(from.y / (from.y - to.y)))
}

fn kept_on_edge(share: f64) -> f64 {
    Lanes::min(Lanes::max(share, 0.0), 1.0)
}
