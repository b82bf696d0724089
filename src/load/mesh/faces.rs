//! Faces of any number of corners, cut into triangles.

use crate::scene::polygon_normal;
use earcut::Earcut;
use glam::DVec3;

/// Triangles that cover a face, each by the places of its corners in the face: a fan where the face is convex, ears cut
/// off where it is not.
pub(super) fn cut_into_triangles(earcut: &mut Earcut<f64>, points: &[DVec3]) -> Vec<[usize; 3]> {
    if is_convex(points) { fan(points.len()) } else { ears(earcut, points) }
}

/// Whether every corner turns the same way about the face's normal, so that a fan covers it.
fn is_convex(points: &[DVec3]) -> bool {
    let Some(normal) = polygon_normal(points) else { return true };
    let count = points.len();
    count == 3
        || (0..count).all(|k| {
            let [before, here, after] = [points[(k + count - 1) % count], points[k], points[(k + 1) % count]];
            (here - before).cross(after - here).dot(normal) >= 0.0
        })
}

/// (0, k, k+1), the order that other tracers count in.
fn fan(count: usize) -> Vec<[usize; 3]> {
    (1..count - 1).map(|k| [0, k, k + 1]).collect()
}

/// A concave face by cutting off ears, seen along the axis in which its normal is largest; a fan where that finds none.
fn ears(earcut: &mut Earcut<f64>, points: &[DVec3]) -> Vec<[usize; 3]> {
    let normal = polygon_normal(points).unwrap_or(DVec3::Z);
    let dropped = normal.abs().max_position();
    let (mut x, mut y) = ((dropped + 1) % 3, (dropped + 2) % 3);
    if normal[dropped] < 0.0 {
        (x, y) = (y, x);
    }
    let mut places: Vec<usize> = Vec::new();
    earcut.earcut(points.iter().map(|point| [point[x], point[y]]), &[], &mut places);
    if places.is_empty() {
        return fan(points.len());
    }
    places
        .chunks_exact(3)
        .map(|corners| upright([corners[0], corners[1], corners[2]], points, normal))
        .collect()
}

/// A triangle in the face's own sense of rotation.
fn upright([a, b, c]: [usize; 3], points: &[DVec3], normal: DVec3) -> [usize; 3] {
    let turns_over = (points[b] - points[a]).cross(points[c] - points[a]).dot(normal) < 0.0;
    if turns_over { [a, c, b] } else { [a, b, c] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the sum of the triangles' areas, signed by the direction along an axis.
    fn double_area(points: &[DVec3], triangles: &[[usize; 3]], axis: usize) -> f64 {
        triangles.iter().map(|&triangle| double_area_of(points, triangle, axis)).sum()
    }

    fn double_area_of(points: &[DVec3], [a, b, c]: [usize; 3], axis: usize) -> f64 {
        (points[b] - points[a]).cross(points[c] - points[a])[axis]
    }

    #[test]
    fn a_convex_face_is_cut_into_a_fan() {
        let points = [[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [1., 2., 0.], [0., 1., 0.]].map(DVec3::from);
        assert_eq!(cut_into_triangles(&mut Earcut::new(), &points), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn a_concave_face_keeps_its_notch_and_its_sense_of_rotation() {
        // An L of area 3, whose fan from the first corner would cover the notch; both senses, all three axes.
        let outline = [[2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.], [0., 0.]];
        for reversed in [false, true] {
            for axis in 0..3 {
                let mut points = outline.map(|[x, y]| {
                    let mut point = DVec3::splat(0.5);
                    (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (x, y);
                    point
                });
                if reversed {
                    points.reverse();
                }
                let sense = if reversed { -1.0 } else { 1.0 };
                let triangles = cut_into_triangles(&mut Earcut::new(), &points);
                assert_eq!(triangles.len(), 4);
                assert_eq!(double_area(&points, &triangles, axis), sense * 6.0, "axis {axis}");
                let turns_alike =
                    |&triangle: &[usize; 3]| double_area_of(&points, triangle, axis) * sense > 0.0;
                assert!(triangles.iter().all(turns_alike), "axis {axis}");
            }
        }
    }
}
