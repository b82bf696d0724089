//! Where a ray meets a sphere, a triangle or a polygon, and what the surface is like there.

use super::in_plane::{self, Part};
use super::ray::{Departure, Ray};
use crate::scene::{Geometry, Material, MaterialId, PrimitiveId};
use glam::DVec3;

/// A primitive with its numbers widened to f64.
pub(super) struct Primitive {
    pub(super) id: PrimitiveId,
    pub(super) material: MaterialId,
    pub(super) casts_shadow: bool,
    pub(super) shape: Shape,
    /// The largest magnitude of a coordinate of its points.
    extent: f64,
}

/// Where a ray meets a primitive.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    /// The ray's parameter, not a length.
    pub(super) t: f64,
    /// More than rounding can have moved t: the rounding of the coordinates, seen at the angle of the ray.
    pub(super) uncertainty: f64,
    /// The way along the normal that the ray makes for each unit of t: a length is so much of t, divided by this.
    pub(super) approach: f64,
}

pub(super) enum Shape {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    Triangle {
        vertices: [DVec3; 3],
        /// Geometric, unit.
        normal: DVec3,
        normals: Option<Box<[DVec3; 3]>>,
    },
    Polygon {
        vertices: Box<[DVec3]>,
        /// Geometric, unit.
        normal: DVec3,
        normals: Option<Box<[DVec3]>>,
    },
}

impl Meeting {
    /// Bound on the rounding of a hit point and of the test of a face that touches it, as a share of the coordinates that
    /// take part: about twenty operations of 2⁻⁵³ each, rounded up. Coordinates come as f32, so a scene cannot hold a
    /// detail that is nearly as small.
    pub(super) const ROUNDING: f64 = 1.0 / (1_u64 << 46) as f64;

    /// Nearer to edge-on, a sphere's limb bends away and a face is no wider than a line, and t is bounded by that. Here
    /// the rounding is 2⁻²⁶ of the coordinates, still below what f32 coordinates can tell apart.
    pub(super) const LEAST_COSINE: f64 = 1.0 / (1 << 20) as f64;
}

/// What a surface is like at a hit, seen from outside.
pub(super) struct Surface {
    pub(super) point: DVec3,
    /// n_g, unit, outward.
    pub(super) geometric_normal: DVec3,
    /// n_s on the side of n_g, unit.
    pub(super) shading_normal: DVec3,
}

impl Primitive {
    /// Every primitive of a scene.
    pub(super) fn all(geometry: &Geometry, materials: &[Material]) -> Vec<Self> {
        let new = |id, material: MaterialId, shape: Shape| {
            let casts_shadow = materials[material.0 as usize].casts_shadow;
            let extent = shape.extent();
            Self { id, material, casts_shadow, shape, extent }
        };
        let vertex = |index: u32| geometry.vertices[index as usize].as_dvec3();
        let normal = |index: u32| geometry.normals[index as usize].as_dvec3();
        let spheres = geometry.spheres.iter().map(|sphere| {
            let shape = Shape::Sphere { center: sphere.center.as_dvec3(), radius: f64::from(sphere.radius) };
            new(sphere.id, sphere.material, shape)
        });
        let triangles = geometry.triangles.iter().map(|triangle| {
            let vertices @ [a, b, c] = triangle.vertices.map(vertex);
            let shape = Shape::Triangle {
                vertices,
                normal: (b - a).cross(c - a).normalize(),
                normals: triangle.normals.map(|normals| Box::new(normals.map(normal))),
            };
            new(triangle.id, triangle.material, shape)
        });
        let polygons = geometry.polygons.iter().map(|polygon| {
            let vertices: Box<[DVec3]> = polygon.vertices.clone().map(vertex).collect();
            let normals = polygon.normals.clone().map(|normals| normals.map(normal).collect());
            let shape = Shape::Polygon { normal: newell_normal(&vertices), vertices, normals };
            new(polygon.id, polygon.material, shape)
        });
        spheres.chain(triangles).chain(polygons).collect()
    }

    /// The smallest t > 0 at which the ray meets it. For a ray that starts on a surface, what differs from 0 by no more
    /// than rounding is 0: this primitive touches that surface there, however large either may be.
    pub(super) fn intersect(&self, ray: &Ray) -> Option<Meeting> {
        let departure = ray.departure.filter(|departure| departure.from == self.id);
        let rounding = rounding_at(ray, self.extent);
        let meeting = |t: f64, normal: DVec3| {
            let length = ray.direction.length();
            let cosine = (normal.dot(ray.direction).abs() / length).max(Meeting::LEAST_COSINE);
            let approach = cosine * length;
            let uncertainty = rounding / approach;
            let least = match ray.departure {
                Some(other) if departure.is_none() => uncertainty + other.off_surface / approach,
                _ => ray.t_min,
            };
            (t > least).then_some(Meeting { t, uncertainty, approach })
        };
        match (&self.shape, departure) {
            (Shape::Sphere { center, radius }, Some(Departure { inward: true, .. })) => {
                let t = far_side(ray, *center);
                meeting(t, (ray.at(t) - *center) / *radius)
            }
            (_, Some(_)) => None,
            (Shape::Sphere { center, radius }, None) => {
                let roots = sphere(ray, *center, *radius)?;
                roots.into_iter().find_map(|t| meeting(t, (ray.at(t) - *center) / *radius))
            }
            (Shape::Triangle { vertices, normal, .. }, None) => {
                let t = triangle(ray, vertices)?.t;
                meeting(exact_beside_start(ray, vertices, (*normal, rounding), t), *normal)
            }
            (Shape::Polygon { vertices, normal, .. }, None) => {
                meeting(polygon(ray, vertices, *normal)?, *normal)
            }
        }
    }

    /// The surface at the hit that [`Self::intersect`] found.
    pub(super) fn surface(&self, ray: &Ray, t: f64) -> Surface {
        // Points are put back onto the primitive, since origin + t·direction is off it by the rounding of t.
        match &self.shape {
            Shape::Sphere { center, radius } => {
                let normal = (ray.at(t) - *center).normalize();
                Surface {
                    point: *center + *radius * normal,
                    geometric_normal: normal,
                    shading_normal: normal,
                }
            }
            Shape::Triangle { vertices: [a, b, c], normal, normals } => {
                // The same test found the hit, so there are weights; the middle only stands in for what cannot be.
                let weights = triangle(ray, &[*a, *b, *c]).map_or([1.0 / 3.0; 3], |hit| hit.barycentric);
                let mean = |of: &[DVec3; 3]| weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2];
                Surface {
                    point: mean(&[*a, *b, *c]),
                    geometric_normal: *normal,
                    shading_normal: match normals {
                        Some(normals) => on_side_of(*normal, mean(normals)),
                        None => *normal,
                    },
                }
            }
            Shape::Polygon { vertices, normal, normals } => {
                let near = ray.at(t);
                let point = near - (near - vertices[0]).dot(*normal) * *normal;
                Surface {
                    point,
                    geometric_normal: *normal,
                    shading_normal: match normals {
                        Some(normals) => on_side_of(*normal, patch_normal(point, vertices, normals, *normal)),
                        None => *normal,
                    },
                }
            }
        }
    }

    /// t, moved to where the ray is within the bounds of this primitive.
    pub(super) fn within_bounds(&self, ray: &Ray, t: f64) -> f64 {
        let (low, high) = self.bounds();
        let [one, other] = [low, high].map(|corner| (corner - ray.origin) / ray.direction);
        // An axis along which the ray does not go has no say.
        let goes_along = |axis: &usize| ray.direction[*axis] != 0.0;
        let leave = (0..3).filter(goes_along).map(|axis| one[axis].max(other[axis])).fold(t, f64::min);
        (0..3).filter(goes_along).map(|axis| one[axis].min(other[axis])).fold(leave, f64::max)
    }

    /// Smallest and largest coordinates; rounded outward where they are computed.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        match &self.shape {
            Shape::Sphere { center, radius } => (
                (*center - DVec3::splat(*radius)).map(f64::next_down),
                (*center + DVec3::splat(*radius)).map(f64::next_up),
            ),
            Shape::Triangle { vertices, .. } => bounds_of(vertices),
            Shape::Polygon { vertices, .. } => bounds_of(vertices),
        }
    }
}

impl Shape {
    fn extent(&self) -> f64 {
        let largest =
            |points: &[DVec3]| points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
        match self {
            Self::Sphere { center, radius } => center.abs().max_element() + radius,
            Self::Triangle { vertices, .. } => largest(vertices),
            Self::Polygon { vertices, .. } => largest(vertices),
        }
    }
}

/// Both t at which the ray's line meets the sphere, the nearer first.
///
/// |o + t·d − c|² = r². The discriminant is taken as r² − l² with l the distance of the centre from the line, since
/// b² − 4ac loses the radius of a sphere far away. Source: Hearn and Baker, "Computer Graphics with OpenGL", as used in
/// Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019.
pub(super) fn sphere(ray: &Ray, center: DVec3, radius: f64) -> Option<[f64; 2]> {
    let from_center = ray.origin - center;
    let a = ray.direction.length_squared();
    let closest_t = -from_center.dot(ray.direction) / a;
    let closest = from_center + closest_t * ray.direction;
    let half_chord_squared = radius * radius - closest.length_squared();
    if half_chord_squared < 0.0 {
        return None;
    }
    let half_chord = (half_chord_squared / a).sqrt();
    // The root of smaller magnitude by the product of the roots, c/a, which keeps digits that a difference would lose.
    let larger = closest_t + half_chord.copysign(closest_t);
    if larger == 0.0 {
        return None;
    }
    let distance = from_center.length();
    let product = (distance - radius) * (distance + radius) / a;
    let smaller = product / larger;
    Some(if smaller < larger { [smaller, larger] } else { [larger, smaller] })
}

/// The second root for a ray that starts on the sphere: with |o − c| = r the quadratic has the roots 0 and this.
fn far_side(ray: &Ray, center: DVec3) -> f64 {
    -2.0 * (ray.origin - center).dot(ray.direction) / ray.direction.length_squared()
}

pub(super) struct TriangleHit {
    pub(super) t: f64,
    /// Weights of the three vertices; they sum to 1.
    barycentric: [f64; 3],
}

/// Seen along the ray, the signed areas that its foot spans with the edges are the barycentric weights, and t is the mean of
/// the vertices' t by these weights. Inside is what is inside of a polygon: see [`crosses`].
pub(super) fn triangle(ray: &Ray, vertices: &[DVec3; 3]) -> Option<TriangleHit> {
    let seen @ [a, b, c] = vertices.map(|vertex| ray.project(vertex));
    let inside =
        [(a, b), (b, c), (c, a)].into_iter().filter(|&(from, to)| crosses(from, to)).count() % 2 == 1;
    let weights = [cross(b, c), cross(c, a), cross(a, b)];
    let area = weights[0] + weights[1] + weights[2];
    if !inside || area == 0.0 {
        return None; // or seen edge-on
    }
    let barycentric = weights.map(|weight| weight / area);
    let t = barycentric[0] * a.z + barycentric[1] * b.z + barycentric[2] * c.z;
    // Seen nearly edge-on, areas may be nothing but rounding; a point of the triangle is no nearer than its nearest vertex.
    let (low, high) = seen.iter().fold((a.z, a.z), |(low, high), seen| (low.min(seen.z), high.max(seen.z)));
    Some(TriangleHit { t: t.clamp(low, high), barycentric })
}

/// Crossing-number test (Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994) of where the ray meets the
/// polygon's plane.
///
/// The polygon is projected along the ray rather than along a coordinate axis. Both keep inside and outside, but axis
/// by axis each face rounds its own hit point, and rays aimed at the edge of a closed solid get out between two faces;
/// seen along the ray two faces share the very numbers of their common edge.
pub(super) fn polygon(ray: &Ray, vertices: &[DVec3], normal: DVec3) -> Option<f64> {
    let mut inside = false;
    let (mut low_t, mut high_t) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut from = ray.project(vertices[vertices.len() - 1]);
    for &vertex in vertices {
        let to = ray.project(vertex);
        inside ^= crosses(from, to);
        (low_t, high_t) = (low_t.min(to.z), high_t.max(to.z));
        from = to;
    }
    // A ray that leaves a surface does not meet what its start touches, by a rule of its own.
    let has_both_sides = low_t <= ray.t_min && ray.t_min < high_t && ray.departure.is_none();
    if !inside && !has_both_sides {
        return None;
    }
    let slope = normal.dot(ray.direction);
    let extent = vertices.iter().map(|vertex| vertex.abs().max_element()).fold(0.0, f64::max);
    let rounding = rounding_at(ray, extent);
    let t = (normal.dot(vertices[0] - ray.origin) / slope).clamp(low_t, high_t);
    let t = exact_beside_start(ray, vertices, (normal, rounding), t);
    let bend = vertices.iter().map(|&vertex| normal.dot(vertex - vertices[0]).abs()).fold(0.0, f64::max);
    let start_height = normal.dot(ray.at(ray.t_min) - vertices[0]).abs();
    if has_both_sides && start_height <= bend + rounding {
        match in_plane::part_beyond(ray, vertices, rounding) {
            Part::StartsOn => {}
            Part::Met(_) if t > ray.t_min => return Some(t),
            Part::Met(edge_t) => {
                // No later than the plane, which seen edge-on may be anywhere.
                let latest = t + (rounding + bend) / slope.abs();
                return Some(edge_t.min(latest).max(ray.t_min.next_up()));
            }
            Part::Passed => return None,
        }
    }
    if !inside || slope == 0.0 {
        return None; // or seen edge-on
    }
    let is_edge_on = slope.abs() < Meeting::LEAST_COSINE * ray.direction.length();
    Some(if is_edge_on { in_plane::kept_between_edges(ray, vertices, t) } else { t })
}

/// t of a face that is met no farther from where the ray starts than rounding can tell: that of the plane by a normal whose length
/// loses nothing, so that a start that is exactly on the face does not meet it.
fn exact_beside_start(ray: &Ray, vertices: &[DVec3], (normal, rounding): (DVec3, f64), t: f64) -> f64 {
    let length = ray.direction.length();
    let approach = normal.dot(ray.direction).abs().max(Meeting::LEAST_COSINE * length);
    if (t - ray.t_min).abs() * approach > rounding {
        return t;
    }
    let double_area = double_area(vertices);
    let t = double_area.dot(point_of_plane(ray, vertices) - ray.origin) / double_area.dot(ray.direction);
    // Edge-on it may be anywhere, but the face is where its vertices are.
    let ts = || vertices.iter().map(|&vertex| ray.project(vertex).z);
    let slack = rounding / ray.direction.abs().max_element();
    t.clamp(ts().fold(f64::INFINITY, f64::min) - slack, ts().fold(f64::NEG_INFINITY, f64::max) + slack)
}

/// The corner that a face's plane goes through. Of three any will do, and the nearest to where the ray starts is at height 0 if it
/// starts there; more may not be quite in a plane, and then it is the first.
fn point_of_plane(ray: &Ray, vertices: &[DVec3]) -> DVec3 {
    let distance = |vertex: DVec3| vertex.distance_squared(ray.origin);
    let nearer = |one, other| if distance(other) < distance(one) { other } else { one };
    match *vertices {
        [a, b, c] => nearer(nearer(a, b), c),
        _ => vertices[0],
    }
}

/// Whether an edge crosses the half-line from the ray's foot along x. Half open: a vertex level with the foot counts as above
/// it, and an edge through it as left of it, for every face alike; so of two faces at an edge one holds what falls on it.
pub(super) fn crosses(from: DVec3, to: DVec3) -> bool {
    // From the lower to the upper end, so that both faces at an edge compute the same.
    let (lower, upper) = if from.y < 0.0 { (from, to) } else { (to, from) };
    lower.y < 0.0 && upper.y >= 0.0 && cross(lower, upper) > 0.0
}

/// Twice the signed area of the triangle (foot of the ray, a, b). The two products are rounded before they are
/// subtracted, so the sign is right or the result is 0, and swapping a and b only changes the sign.
pub(super) fn cross(a: DVec3, b: DVec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// How far a hit point may be off a primitive by rounding, which reaches so far from the world's origin.
fn rounding_at(ray: &Ray, extent: f64) -> f64 {
    Meeting::ROUNDING * (extent + ray.origin.abs().max_element())
}

/// Newell's normal, unit Σ p_k × p_k+1.
fn newell_normal(vertices: &[DVec3]) -> DVec3 {
    double_area(vertices).normalize()
}

/// As long as twice the area.
fn double_area(vertices: &[DVec3]) -> DVec3 {
    let origin = vertices[0];
    let next = vertices.iter().cycle().skip(1);
    vertices.iter().zip(next).fold(DVec3::ZERO, |sum, (&from, &to)| sum + (from - origin).cross(to - origin))
}

/// The barycentric mean of a patch's normals over the triangle of its fan (0, k, k+1) that holds the point; where
/// rounding or a concave outline leaves the point outside all of them, the one that it is least outside of.
fn patch_normal(point: DVec3, vertices: &[DVec3], normals: &[DVec3], plane: DVec3) -> DVec3 {
    let candidates = (1..vertices.len() - 1).filter_map(|k| {
        let [a, b, c] = [vertices[0], vertices[k], vertices[k + 1]];
        let area = plane.dot((b - a).cross(c - a));
        let v = plane.dot((point - a).cross(c - a)) / area;
        let w = plane.dot((b - a).cross(point - a)) / area;
        let u = 1.0 - v - w;
        let normal = u * normals[0] + v * normals[k] + w * normals[k + 1];
        (area != 0.0).then(|| (u.min(v).min(w), normal))
    });
    candidates.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(plane, |(_, normal)| normal)
}

/// A vertex normal's mean, unit and on the side of n_g; n_g itself where the mean has no direction.
fn on_side_of(geometric_normal: DVec3, mean: DVec3) -> DVec3 {
    match mean.try_normalize() {
        None => geometric_normal,
        Some(normal) if normal.dot(geometric_normal) < 0.0 => -normal,
        Some(normal) => normal,
    }
}

fn bounds_of(points: &[DVec3]) -> (DVec3, DVec3) {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn t_of_sphere(origin: [f64; 3], direction: [f64; 3], center: [f64; 3], radius: f64) -> Option<f64> {
        let ray = Ray::new(DVec3::from(origin), DVec3::from(direction), None);
        sphere(&ray, DVec3::from(center), radius)?.into_iter().find(|&t| t > 0.0)
    }

    #[track_caller]
    fn assert_t(found: Option<f64>, expected: f64, relative: f64) {
        let found = found.expect("a hit");
        assert!((found - expected).abs() <= relative * expected, "t = {found:e}, expected {expected:e}");
    }

    #[test]
    fn spheres_far_away_keep_their_shape() {
        // At half the radius off the axis the near point is √(1 − ¼) before the centre.
        for distance in [100.0, 4100.0, 65536.0, 1e6, 1e9] {
            let t = t_of_sphere([0.0, 0.5, -distance], [0.0, 0.0, 1.0], [0.0; 3], 1.0);
            assert_t(t, distance - 0.75_f64.sqrt(), 1e-15);
        }
    }

    #[test]
    fn spheres_are_touched_or_missed_at_the_limb() {
        let at_height = |y: f64| t_of_sphere([0.0, y, -4.0], [0.0, 0.0, 1.0], [0.0; 3], 1.0);
        assert_eq!(at_height(1.0), Some(4.0));
        assert_eq!(at_height(1.0_f64.next_up()), None);
        assert!(at_height(1.0_f64.next_down()).is_some_and(|t| t < 4.0));
    }

    #[test]
    fn a_ground_of_large_radius_is_met_where_it_is() {
        // The smaller root in sixty decimal digits. Sixteen lose six of them here: the origin is 1 above a ball of 10⁶.
        let t = t_of_sphere([0.0, 1.0, -5.0], [0.0, -0.6, 0.8], [0.0, -1e6, 0.0], 1e6);
        assert_t(t, 1.666_677_870_315_597, 1e-9);
    }

    #[test]
    fn spheres_are_met_from_inside_and_not_from_before_them() {
        assert_eq!(t_of_sphere([0.0, 0.0, 0.5], [0.0, 0.0, 1.0], [0.0; 3], 1.0), Some(0.5));
        assert_eq!(t_of_sphere([0.0; 3], [0.0, 0.0, 1.0], [0.0; 3], 1.0), Some(1.0));
        assert_eq!(t_of_sphere([0.0, 0.0, 2.0], [0.0, 0.0, 1.0], [0.0; 3], 1.0), None);
        // t is the ray's parameter: half of it for twice the direction.
        assert_eq!(t_of_sphere([0.0, 0.0, -3.0], [0.0, 0.0, 2.0], [0.0; 3], 1.0), Some(1.0));
    }

    #[test]
    fn a_polygon_seen_edge_on_is_met_within_its_outline_or_not_at_all() {
        // A square whose plane f64 cannot hold, and rays in that plane to rounding.
        let (u, v) = (DVec3::new(0.3, 0.7, -0.2).normalize(), DVec3::new(0.7, -0.3, 0.1));
        let v = (v - v.dot(u) * u).normalize();
        let vertices = [u + v, v - u, -u - v, u - v];
        let normal = newell_normal(&vertices);
        let mut hits = 0;
        for step in 0..20_000 {
            let (sin, cos) = (f64::from(step) * 0.001).sin_cos();
            let direction = sin * u + cos * v;
            let origin = -3.0 * direction + 0.3 * (cos * u - sin * v);
            if let Some(t) = polygon(&Ray::new(origin, direction, None), &vertices, normal) {
                hits += 1;
                let distance = (origin + t * direction).length();
                // The corners are √2 from the middle, and along an axis of the world at most √3 times as much.
                assert!(distance < 2.5, "step {step}: t = {t} is {distance} from the middle of the square");
            }
        }
        assert!(hits > 100, "only {hits} rays of this kind hit");
    }
}
