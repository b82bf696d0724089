//! What is known of a face in f64, once its corners are f32.

use glam::DVec3;

/// 2⁻²⁴.
pub(super) const UNIT_ROUNDOFF: f64 = 1.0 / (1_u64 << 24) as f64;

/// A face in f64.
pub(super) struct Flat {
    pub(super) corners: Vec<DVec3>,
    /// Unit Σ p_k × p_k+1.
    pub(super) normal: DVec3,
    /// Of a polygon, how far corners lie off the plane through the first.
    pub(super) bend: f64,
    /// The least distance between a corner and an edge that does not end there.
    width: f64,
    longest_edge: f64,
    is_polygon: bool,
}

impl Flat {
    pub(super) fn new(corners: Vec<DVec3>, is_polygon: bool) -> Self {
        let first = corners[0];
        let sum: DVec3 = corners.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum();
        let normal = sum.normalize();
        let bend = corners.iter().map(|corner| normal.dot(corner - first).abs()).fold(0.0, f64::max);
        let count = corners.len();
        let mut width = f64::INFINITY;
        let mut longest_edge = 0.0_f64;
        for from in 0..count {
            let to = (from + 1) % count;
            longest_edge = longest_edge.max(corners[from].distance(corners[to]));
            for corner in (0..count).filter(|&corner| corner != from && corner != to) {
                width = width.min(to_segment(corners[corner], corners[from], corners[to]));
            }
        }
        Self { corners, normal, bend: if is_polygon { bend } else { 0.0 }, width, longest_edge, is_polygon }
    }

    /// The share of all directions that a face takes up as seen from a point, × 4π; positive from behind.
    ///
    /// Source: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983. Of polygons the triangles of a fan add up,
    /// those that turn the other way with the other sign.
    pub(super) fn solid_angle(&self, from: DVec3) -> f64 {
        let [first, rest @ ..] = &self.corners[..] else { return 0.0 };
        let angle = |pair: &[DVec3]| {
            let [a, b, c] = [first - from, pair[0] - from, pair[1] - from];
            let [p, q, r] = [a, b, c].map(DVec3::length);
            2.0 * a.dot(b.cross(c)).atan2(p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q)
        };
        rest.windows(2).map(angle).sum()
    }

    /// How far a point may move before an f32 tracer may be wrong about on which side of the face it is; below 0 where it may
    /// be already. Not exact where it is more than `enough`.
    pub(super) fn clearance(&self, point: DVec3, enough: f64) -> f64 {
        let error = self.error(point);
        let from_plane = self.normal.dot(point - self.corners[0]).abs() - self.bend - error;
        if from_plane > enough { from_plane } else { self.distance(point) - error }
    }

    /// 16 roundings of the distance to the farthest corner, for a triangle also of s²/h, its longest edge squared over the
    /// height above it: some two times what triangles were measured to be off by (see `kernel::triangle`); and what a polygon is bent by.
    fn error(&self, point: DVec3) -> f64 {
        let shape = if self.is_polygon { 0.0 } else { self.longest_edge * self.longest_edge / self.width };
        16.0 * UNIT_ROUNDOFF * (self.farthest(point) + shape) + 4.0 * self.bend
    }

    /// What that makes of the t of a ray; infinite if it sees the face edge-on.
    pub(super) fn error_of_t(&self, row: [f32; 8]) -> f64 {
        let [ox, oy, oz, _, dx, dy, dz, _] = row.map(f64::from);
        self.error(DVec3::new(ox, oy, oz)) / self.normal.dot(DVec3::new(dx, dy, dz)).abs()
    }

    /// Whether every point within some reach of a point sees the inner side of the face, and sees it so wide that no rounding
    /// of corners could turn it around.
    pub(super) fn is_seen_from_inside(&self, point: DVec3, reach: f64) -> bool {
        let height = self.normal.dot(self.corners[0] - point) - reach;
        let farthest = self.farthest(point) + reach;
        // Seen from there its width is foreshortened to width·height/farthest; corners are off by some 5u·farthest.
        height > 8.0 * self.bend && height * self.width > 32.0 * UNIT_ROUNDOFF * farthest * farthest
    }

    fn farthest(&self, point: DVec3) -> f64 {
        self.corners.iter().map(|corner| corner.distance(point)).fold(0.0, f64::max)
    }

    /// From a point to the nearest of a fan of triangles, which covers the face and, if that is concave, more.
    fn distance(&self, point: DVec3) -> f64 {
        let [first, rest @ ..] = &self.corners[..] else { return f64::INFINITY };
        rest.windows(2)
            .map(|pair| to_triangle(point, [*first, pair[0], pair[1]]))
            .fold(f64::INFINITY, f64::min)
    }
}

fn to_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(from + share * along)
}

fn to_triangle(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let is_over = |from: DVec3, to: DVec3| normal.dot((to - from).cross(point - from)) >= 0.0;
    if normal != DVec3::ZERO && is_over(a, b) && is_over(b, c) && is_over(c, a) {
        return normal.normalize().dot(point - a).abs();
    }
    to_segment(point, a, b).min(to_segment(point, b, c)).min(to_segment(point, c, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_face_of_a_cube_takes_a_sixth_of_all_directions_and_a_concave_one_what_its_parts_take() {
        let square = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
        let square = Flat::new(square.to_vec(), true);
        assert!((square.solid_angle(DVec3::ZERO) - 4.0 * PI / 6.0).abs() < 1e-12);
        assert!((square.solid_angle(DVec3::new(0.0, 0.0, 2.0)) + 4.0 * PI / 6.0).abs() < 1e-12);
        let flat = |corners: &[(f64, f64)]| {
            Flat::new(corners.iter().map(|&(x, y)| DVec3::new(x, y, 1.0)).collect(), true)
        };
        // Its first corner does not see all of it.
        let concave = flat(&[(2.0, 1.0), (0.0, 1.0), (0.0, 3.0), (-1.0, 3.0), (-1.0, 0.0), (2.0, 0.0)]);
        let parts = [
            flat(&[(2.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (2.0, 0.0)]),
            flat(&[(0.0, 1.0), (0.0, 3.0), (-1.0, 3.0), (-1.0, 1.0)]),
        ];
        let point = DVec3::new(0.3, 0.2, -0.4);
        let sum: f64 = parts.iter().map(|part| part.solid_angle(point)).sum();
        assert!((concave.solid_angle(point) - sum).abs() < 1e-12);
    }

    #[test]
    fn distances_from_triangles_are_those_of_the_nearest_point() {
        let triangle = [DVec3::ZERO, 4.0 * DVec3::X, 3.0 * DVec3::Y];
        for (point, distance) in [
            (DVec3::new(1.0, 1.0, 2.0), 2.0),
            (DVec3::new(2.0, -3.0, 4.0), 5.0),
            (DVec3::new(-3.0, -4.0, 12.0), 13.0),
            (DVec3::new(4.0, 3.0, 0.0), 2.4),
        ] {
            assert!((to_triangle(point, triangle) - distance).abs() < 1e-12, "{point}");
        }
    }
}
