//! Where a point of a polygon's plane is from the polygon's outline.

use crate::lanes::Lanes;
use glam::{DVec3, Vec3};

/// For a point beside the outline, the nearest point on it; none for a point inside. Corners and the point are in one space,
/// and seen along the axis in which the normal is largest.
#[inline(always)]
pub(super) fn beside(corners: &[Vec3], point: [f64; 3], normal: [f64; 3]) -> Option<[f64; 3]> {
    (!holds(corners, point, normal)).then(|| nearest(corners, DVec3::from(point)).to_array())
}

/// The crossing number: Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994.
#[inline(always)]
fn holds(corners: &[Vec3], point: [f64; 3], normal: [f64; 3]) -> bool {
    let [x, y, z] = normal.map(f64::abs);
    let (u, v) = if x >= y && x >= z {
        (1, 2)
    } else if y >= z {
        (2, 0)
    } else {
        (0, 1)
    };
    let seen = |corner: &Vec3| {
        let corner: &[f32; 3] = corner.as_ref();
        [f64::from(corner[u]) - point[u], f64::from(corner[v]) - point[v]]
    };
    let mut is_inside = false;
    let mut from = corners.last().map_or([0.0; 2], seen);
    for corner in corners {
        let to = seen(corner);
        let crosses = (from[1] > 0.0) != (to[1] > 0.0);
        is_inside ^= crosses & ((from[0] * to[1] > from[1] * to[0]) == (to[1] > from[1]));
        from = to;
    }
    is_inside
}

#[cold]
fn nearest(corners: &[Vec3], point: DVec3) -> DVec3 {
    let mut nearest = (f64::INFINITY, point);
    let mut from = corners.last().map_or(point, |corner| corner.as_dvec3());
    for to in corners.iter().map(|corner| corner.as_dvec3()) {
        let edge = to - from;
        let length_squared = edge.length_squared();
        let share = if length_squared > 0.0 { (point - from).dot(edge) / length_squared } else { 0.0 };
        let at = from + edge * Lanes::min(Lanes::max(share, 0.0), 1.0);
        let distance = at.distance_squared(point);
        if distance < nearest.0 {
            nearest = (distance, at);
        }
        from = to;
    }
    nearest.1
}

#[cfg(test)]
mod tests {
    use super::*;

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
                    assert_eq!(
                        beside(&corners, place(point), normal),
                        expected.map(place),
                        "{point:?}, axis {axis}"
                    );
                }
                corners.reverse();
            }
        }
    }
}
