//! Faces of any number of corners, cut into triangles.

use crate::scene::polygon_normal;
use earcut::Earcut;
use glam::DVec3;

/// Cuts faces, one after the other in the memory of one.
#[derive(Default)]
pub(super) struct Cutter {
    earcut: Earcut<f64>,
    points: Vec<DVec3>,
    ears: Vec<usize>,
    triangles: Vec<[usize; 3]>,
}

impl Cutter {
    /// Triangles that cover a face, each by the places of its corners in the face: a fan where the face is convex, ears
    /// cut off where it is not.
    pub(super) fn cut(&mut self, points: impl Iterator<Item = DVec3>) -> &[[usize; 3]] {
        self.points.clear();
        self.points.extend(points);
        self.triangles.clear();
        if !is_convex(&self.points) {
            self.cut_ears();
        }
        // Ears may find nothing in a face that crosses itself.
        if self.triangles.is_empty() {
            self.cut_fan();
        }
        &self.triangles
    }

    /// (0, k, k+1), the order that other tracers count in.
    fn cut_fan(&mut self) {
        self.triangles.extend((1..self.points.len() - 1).map(|k| [0, k, k + 1]));
    }

    /// Ears, seen along the axis in which the normal is largest.
    fn cut_ears(&mut self) {
        let points = &self.points;
        let normal = polygon_normal(points).unwrap_or(DVec3::Z);
        let dropped = normal.abs().max_position();
        let (mut x, mut y) = ((dropped + 1) % 3, (dropped + 2) % 3);
        if normal[dropped] < 0.0 {
            (x, y) = (y, x);
        }
        self.ears.clear();
        self.earcut.earcut(points.iter().map(|point| [point[x], point[y]]), &[], &mut self.ears);
        let (triangles, _) = self.ears.as_chunks();
        self.triangles.extend(triangles.iter().map(|&corners| upright(corners, points, normal)));
    }
}

/// Whether every corner turns the same way about the face's normal, so that a fan covers it.
fn is_convex(points: &[DVec3]) -> bool {
    let count = points.len();
    if count == 3 {
        return true;
    }
    let Some(normal) = polygon_normal(points) else { return true };
    (0..count).all(|k| {
        let [before, here, after] = [points[(k + count - 1) % count], points[k], points[(k + 1) % count]];
        (here - before).cross(after - here).dot(normal) >= 0.0
    })
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
        assert_eq!(Cutter::default().cut(points.into_iter()), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
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
                let mut cutter = Cutter::default();
                let triangles = cutter.cut(points.into_iter());
                assert_eq!(triangles.len(), 4);
                assert_eq!(double_area(&points, triangles, axis), sense * 6.0, "axis {axis}");
                let turns_alike =
                    |&triangle: &[usize; 3]| double_area_of(&points, triangle, axis) * sense > 0.0;
                assert!(triangles.iter().all(turns_alike), "axis {axis}");
            }
        }
    }
}
