//! Where a polygon is from a point of its plane, and from a ray along its plane.

use crate::lanes::{Double, Lanes, Mask, Vector};
use glam::{DVec2, DVec3, Vec3};

/// Whether the outline holds each of some points of its plane. Corners and points are in one space, and seen along the axis in
/// which the normal is largest. The crossing number: Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994.
#[inline(always)]
pub(super) fn holds<D: Double>(corners: &[Vec3], points: Vector<D>, normal: DVec3) -> D::Mask {
    let dropped = normal.abs().max_position();
    let (u, v) = ((dropped + 1) % 3, (dropped + 2) % 3);
    let points = [points.x, points.y, points.z];
    let zero = D::splat(0.0);
    let seen = |corner: &Vec3| {
        let corner: &[f32; 3] = corner.as_ref();
        [u, v].map(|axis| D::splat(f64::from(corner[axis])) - points[axis])
    };
    let mut is_inside = D::Mask::NONE;
    let mut from = corners.last().map_or([zero; 2], seen);
    for corner in corners {
        let to = seen(corner);
        let crosses = from[1].gt(zero).xor(to[1].gt(zero));
        let is_left = (from[0] * to[1]).gt(from[1] * to[0]);
        is_inside = is_inside.xor(crosses & !is_left.xor(to[1].gt(from[1])));
        from = to;
    }
    is_inside
}

/// The point of the outline that is nearest to one in the same space.
#[cold]
pub(super) fn nearest(corners: &[Vec3], point: DVec3) -> DVec3 {
    let mut nearest = (f64::INFINITY, point);
    let mut from = corners.last().map_or(point, |corner| corner.as_dvec3());
    for to in corners.iter().map(|corner| corner.as_dvec3()) {
        let edge = to - from;
        let length_squared = edge.length_squared();
        let share = if length_squared > 0.0 { (point - from).dot(edge) / length_squared } else { 0.0 };
        let at = from + edge * kept_on_edge(share);
        let distance = at.distance_squared(point);
        if distance < nearest.0 {
            nearest = (distance, at);
        }
        from = to;
    }
    nearest.1
}

/// t of a ray that sees the polygon edge-on and is known to meet it, as far as f32 can tell: one that `t` stands for, moved to
/// between the edges on either side of the ray. If f64 sees the ray pass outside, that of the nearest point of an edge. Corners
/// and the ray are in one space.
#[cold]
pub(super) fn kept_between_edges(corners: &[Vec3], [origin, direction]: [DVec3; 2], t: f64) -> f64 {
    let third = direction.abs().max_position();
    // As seen along the ray, with t for the third coordinate.
    let see = |corner: &Vec3| {
        let from_origin = corner.as_dvec3() - origin;
        let t = from_origin[third] / direction[third];
        let at = from_origin - direction * t;
        DVec3::new(at[(third + 1) % 3], at[(third + 2) % 3], t)
    };
    // Distance from the ray, and t.
    let nothing = (f64::INFINITY, t);
    let (mut left, mut right, mut nearest) = (nothing, nothing, nothing);
    let keep_nearer = |place: &mut (f64, f64), (distance, t): (f64, f64)| {
        if distance < place.0 {
            *place = (distance, t);
        }
    };
    let mut is_inside = false;
    let mut from = corners.last().map_or(DVec3::ZERO, see);
    for to in corners.iter().map(see) {
        let share = share_nearest(from.truncate(), to.truncate(), DVec2::ZERO);
        let at = from.lerp(to, share);
        keep_nearer(&mut nearest, (at.truncate().length(), at.z));
        if (from.y < 0.0) != (to.y < 0.0) {
            let at = from.lerp(to, from.y / (from.y - to.y));
            let is_right = at.x > 0.0;
            is_inside ^= is_right;
            keep_nearer(if is_right { &mut right } else { &mut left }, (at.x.abs(), at.z));
        }
        from = to;
    }
    let (one, other) = if is_inside { (left.1, right.1) } else { (nearest.1, nearest.1) };
    Lanes::max(Lanes::min(t, Lanes::max(one, other)), Lanes::min(one, other))
}

/// How far along an edge its nearest point is, from 0 to 1.
fn share_nearest(from: DVec2, to: DVec2, point: DVec2) -> f64 {
    let edge = to - from;
    let length_squared = edge.length_squared();
    // Of an edge seen as a point it would be no number.
    if length_squared > 0.0 { kept_on_edge((point - from).dot(edge) / length_squared) } else { 0.0 }
}

fn kept_on_edge(share: f64) -> f64 {
    Lanes::min(Lanes::max(share, 0.0), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arm of a U, from u = 0 to u = 1, which the ray crosses in the middle, almost along its plane, at v = 2.
    #[test]
    fn a_ray_along_the_plane_meets_the_polygon_between_its_edges() {
        let outline =
            [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for (axis, t) in (0..3).flat_map(|axis| [1.3, 0.5, 2.7, 7.0].map(|t| (axis, t))) {
            let place = |u: f64, v: f64, height: f64| {
                let mut point = DVec3::ZERO;
                (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (height, u, v);
                point
            };
            let mut corners = outline.map(|[u, v]| place(u, v, 0.0).as_vec3());
            let ray = [place(-1.0, 2.0, -1.5e-9), place(1.0, 0.0, 1e-9)];
            for _ in 0..2 {
                let found = kept_between_edges(&corners, ray, t);
                assert!((1.0..=2.0).contains(&found), "{found} for {t}, axis {axis}");
                corners.reverse();
            }
        }
    }

    /// An L in a plane across each axis, either way round.
    #[test]
    fn what_is_beside_a_concave_outline_is_brought_to_its_nearest_edge_or_corner() {
        let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let cases = [
            ([0.5, 0.5], None),
            ([2.0, 0.5], None),
            ([0.5, 2.5], None),
            ([2.0, 1.25], Some([2.0, 1.0])),
            ([1.5, 2.0], Some([1.0, 2.0])),
            ([-0.5, 1.0], Some([0.0, 1.0])),
            ([4.0, -1.0], Some([3.0, 0.0])),
            ([3.5, 0.5], Some([3.0, 0.5])),
        ];
        for axis in 0..3 {
            let place = |[u, v]: [f64; 2]| {
                let mut point = [5.0; 3];
                (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (u, v);
                point
            };
            let mut normal = [0.25; 3];
            normal[axis] = -1.0;
            let mut corners = outline.map(|corner| DVec3::from(place(corner)).as_vec3());
            for _ in 0..2 {
                for (point, expected) in cases {
                    let point = place(point);
                    let is_inside: bool = holds::<f64>(&corners, Vector::splat(point), DVec3::from(normal));
                    let found = (!is_inside).then(|| nearest(&corners, DVec3::from(point)).to_array());
                    assert_eq!(found, expected.map(place), "{point:?}, axis {axis}");
                }
                corners.reverse();
            }
        }
    }
}
