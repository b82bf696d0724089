//! Questions about one ray and one primitive, from the very f32 numbers that a kernel is given.

use super::certainty::{self, Stretches};
use super::precision::Precision;
use super::ray::Ray;
use super::shape;
use crate::scene::polygon_normal;
use glam::DVec3;

/// Where a ray's half-line t > 0 meets a primitive, in truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PairTruth {
    /// The smallest t > 0; none on a miss.
    pub(crate) t: Option<f64>,
    /// The t, of either sign, at which the ray's line meets a sphere as well.
    pub(crate) other_t: Option<f64>,
    /// What rounding the primitive's place by 2⁻²⁴ of its distance does to t; see [`Met::t_per_rounding`](super::Met).
    /// Means nothing on a miss.
    pub(crate) t_per_rounding: f64,
    /// Whether every test whose only fault is rounding to f32 finds a hit, or every one finds none.
    pub(crate) decision_is_certain: bool,
    /// Whether every such test that finds a hit finds it on the same side of a sphere; true of faces.
    pub(crate) side_is_certain: bool,
}

impl PairTruth {
    pub(crate) fn of_sphere([origin, direction]: [[f32; 3]; 2], center: [f32; 3], radius: f32) -> Self {
        let [origin, direction, center] = [origin, direction, center].map(wide);
        let radius = f64::from(radius);
        let ray = Ray::new(origin, direction, None);
        let roots = shape::sphere(&ray, center, radius);
        let (t, other_t) = match roots {
            Some([near, far]) if near > 0.0 => (Some(near), Some(far)),
            Some([near, far]) if far > 0.0 => (Some(far), Some(near)),
            _ => (None, None),
        };
        let normal = |t: f64| (ray.at(t) - center) / radius;
        let approach = t.map_or(0.0, |t| normal(t).dot(direction).abs());
        let farthest = center.distance(origin) + radius;
        let stretches = certainty::sphere(&unit(&ray), center, radius);
        Self::new(t, other_t, Precision::ROUNDING * farthest / approach, stretches)
    }

    pub(crate) fn of_triangle([origin, direction]: [[f32; 3]; 2], vertices: [[f32; 3]; 3]) -> Self {
        let ([origin, direction], vertices) = ([origin, direction].map(wide), vertices.map(wide));
        let ray = Ray::new(origin, direction, None);
        let t = shape::triangle(&ray, &vertices).map(|hit| hit.t).filter(|&t| t > 0.0);
        let [a, b, c] = vertices;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let farthest = vertices.iter().map(|vertex| vertex.distance(origin)).fold(0.0, f64::max);
        let approach = normal.dot(direction).abs();
        let stretches = certainty::outline(&unit(&ray), &vertices, normal);
        Self::new(t, None, Precision::ROUNDING * farthest / approach, stretches)
    }

    /// Corners in the order of the outline, three or more, not all on a line.
    pub(crate) fn of_polygon([origin, direction]: [[f32; 3]; 2], corners: &[[f32; 3]]) -> Self {
        let [origin, direction] = [origin, direction].map(wide);
        let corners: Vec<DVec3> = corners.iter().copied().map(wide).collect();
        let ray = Ray::new(origin, direction, None);
        let normal = polygon_normal(&corners).unwrap_or(DVec3::Z);
        let t = shape::polygon(&ray, &corners, normal).filter(|&t| t > 0.0);
        let farthest = corners.iter().map(|corner| corner.distance(origin)).fold(0.0, f64::max);
        let approach = normal.dot(direction).abs();
        let stretches = certainty::outline(&unit(&ray), &corners, normal);
        Self::new(t, None, Precision::ROUNDING * farthest / approach, stretches)
    }

    fn new(
        t: Option<f64>,
        other_t: Option<f64>,
        t_per_rounding: f64,
        (stretches, is_met): Stretches,
    ) -> Self {
        let stretches = || stretches.into_iter().flatten();
        let may_hit = stretches().any(|[_, to]| to > 0.0);
        let must_hit = is_met && stretches().any(|[from, _]| from > 0.0);
        Self {
            t,
            other_t,
            t_per_rounding,
            decision_is_certain: may_hit == must_hit,
            side_is_certain: stretches().all(|[from, to]| from > 0.0 || to <= 0.0),
        }
    }
}

fn wide(point: [f32; 3]) -> DVec3 {
    DVec3::from(point.map(f64::from))
}

/// With a direction of length 1, as the bounds of rounding want it.
fn unit(ray: &Ray) -> Ray {
    Ray::new(ray.origin, ray.direction.normalize(), None)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: [f32; 3] = [0.0, 0.0, -2.0];

    fn of_unit_sphere(origin: [f32; 3]) -> PairTruth {
        PairTruth::of_sphere([origin, DOWN], [0.0; 3], 1.0)
    }

    #[test]
    fn the_nearest_root_above_zero_is_the_hit_of_a_sphere_and_the_other_is_told() {
        let roots = |z: f32| {
            let truth = of_unit_sphere([0.0, 0.0, z]);
            assert!(truth.decision_is_certain && truth.side_is_certain, "from {z}");
            (truth.t, truth.other_t)
        };
        assert_eq!(roots(3.0), (Some(1.0), Some(2.0)));
        assert_eq!(roots(0.5), (Some(0.75), Some(-0.25)));
        assert_eq!(roots(-3.0), (None, None));
    }

    #[test]
    fn at_a_limb_the_decision_is_open_and_on_the_surface_the_side() {
        let limb = of_unit_sphere([1.0, 0.0, 3.0]);
        assert!(!limb.decision_is_certain);
        let start = of_unit_sphere([0.0, 0.0, 1.0]);
        assert!(
            start.decision_is_certain && !start.side_is_certain,
            "the far side is met for certain: {start:?}"
        );
    }

    #[test]
    fn triangles_are_met_once_and_their_edges_are_open() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let from = |x: f32, z: f32| PairTruth::of_triangle([[x, 0.25, z], DOWN], corners);
        let inside = from(0.25, 3.0);
        assert_eq!((inside.t, inside.other_t, inside.decision_is_certain), (Some(1.5), None, true));
        // Met head-on by a direction of length 2, half of u·L, with L the distance to the farthest corner.
        let farthest = (0.75_f64.powi(2) + 0.25_f64.powi(2) + 9.0).sqrt();
        assert!((inside.t_per_rounding / (farthest / f64::from(1 << 25)) - 1.0).abs() < 1e-12);
        assert_eq!((from(0.8, 3.0).t, from(0.8, 3.0).decision_is_certain), (None, true));
        assert_eq!((from(0.25, -3.0).t, from(0.25, -3.0).decision_is_certain), (None, true));
        assert!(!from(0.75, 3.0).decision_is_certain, "on an edge");
    }

    #[test]
    fn polygons_are_met_inside_their_outline_however_it_turns() {
        // An L: the square without its upper right quarter.
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [-1.0, 1.0]];
        let corners = corners.map(|[x, y]: [f32; 2]| [x, y, 0.0]);
        let at = |x: f32, y: f32| {
            let truth = PairTruth::of_polygon([[x, y, 3.0], DOWN], &corners);
            (truth.t, truth.decision_is_certain)
        };
        assert_eq!([at(-0.5, 0.5), at(0.5, -0.5)], [(Some(1.5), true); 2]);
        assert_eq!(at(0.5, 0.5), (None, true));
        assert!(!at(0.5, 0.0).1, "on an edge");
        let farthest = 11.0_f64.sqrt();
        let truth = PairTruth::of_polygon([[0.0, 0.0, 3.0], DOWN], &corners);
        assert!((truth.t_per_rounding / (farthest / f64::from(1 << 25)) - 1.0).abs() < 1e-12);
    }
}
