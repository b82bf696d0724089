//! Whether an engine in single precision could honestly see another primitive than the true one.
//!
//! Near an edge, a limb or a second surface the answer turns on the last bits of numbers that such an engine has rounded,
//! and no answer of its is wrong. Everywhere else it has to see what the truth is.
//!
//! With u = 2⁻²⁴, a ray of unit direction from o, and a primitive no point of which is farther from o than L:
//!
//! - A test of an edge or a limb in f32 is right for a primitive whose points are moved by at most 6uL: each is taken
//!   relative to o and turned into the ray's frame, three roundings a coordinate, and as many in what is decided from
//!   them. Observed are 5.2uL for spheres and less for triangles.
//! - The ray itself is rounded. At distance s it is off sideways by at most √3·u·s for its direction, whose components
//!   round by u each, and u·|o| for its origin; and s ≤ L.
//!
//! So a ray that passes an edge or a limb by more than the [`band`] (6 + √3)uL + u|o| is on the true side of it. A ray
//! moved sideways by b, or a plane moved by b along its normal, is met elsewhere by at most b/cos θ, θ the angle to
//! the normal; this bounds t, and a primitive's own nearest and farthest points bound it where cos θ is small.

use super::hierarchy::Hierarchy;
use super::ray::{Departure, Ray};
use super::shape::{Primitive, Shape};
use crate::scene::PrimitiveId;
use glam::{DVec2, DVec3, Vec3Swizzles};

/// What a primary ray sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrimaryHit {
    /// The closest primitive; none where the ray misses everything.
    pub id: Option<PrimitiveId>,
    /// Whether every engine whose only fault is rounding to f32 sees the same.
    pub is_certain: bool,
}

/// 2⁻²⁴, half the spacing of f32 numbers around 1.
const U: f64 = 1.0 / (1 << 24) as f64;

/// How far rounding can move a ray and an outline apart: see the module.
fn band(origin: DVec3, farthest: f64) -> f64 {
    U * ((6.0 + 3.0_f64.sqrt()) * farthest + origin.length())
}

/// The primitive, or the miss, that every engine sees along a ray of unit direction before `t_max`; none where they may
/// differ.
pub(super) fn certain_hit(hierarchy: &Hierarchy, ray: &Ray, t_max: f64) -> Option<Option<PrimitiveId>> {
    let widest = widest_band(hierarchy, ray);
    let mut sightings = Sightings { end: t_max, ..Sightings::NONE };
    hierarchy.visit(ray, widest, t_max, |primitive| {
        sightings.add(primitive, ray);
        sightings.end + 2.0 * widest
    });
    sightings.verdict(t_max)
}

/// Whether every engine finds that something, or nothing, that casts a shadow is met before `t_max` along a ray of unit
/// direction; none where they may differ.
pub(super) fn certain_shadow(hierarchy: &Hierarchy, ray: &Ray, t_max: f64) -> Option<bool> {
    let (mut is_certain, mut may_be) = (false, false);
    let widest = widest_band(hierarchy, ray);
    hierarchy.visit(ray, widest, t_max, |primitive| {
        if primitive.casts_shadow {
            let (stretches, is_met) = stretches(primitive, ray);
            for [from, to] in stretches.into_iter().flatten() {
                // The end is rounded as the primitive is.
                let slack = to - from;
                is_certain |= is_met && from > ray.t_min && to + slack < t_max;
                may_be |= to > ray.t_min && from - slack < t_max;
            }
        }
        if is_certain { f64::NEG_INFINITY } else { t_max + 2.0 * widest }
    });
    (is_certain == may_be).then_some(is_certain)
}

/// With the largest coordinate E of the scene, L ≤ √3(E + |o|) and |o| ≤ √3·max|o_i|: no band is wider than this.
fn widest_band(hierarchy: &Hierarchy, ray: &Ray) -> f64 {
    16.0 * U * (hierarchy.extent() + ray.origin.abs().max_element())
}

/// What an engine may meet along a ray.
struct Sightings {
    /// Primitives, and the least t at which an engine may meet them.
    all: Vec<(PrimitiveId, f64)>,
    /// The least t up to which every engine has met something.
    end: f64,
}

impl Sightings {
    const NONE: Self = Self { all: Vec::new(), end: f64::INFINITY };

    fn add(&mut self, primitive: &Primitive, ray: &Ray) {
        let (stretches, is_certain) = stretches(primitive, ray);
        for [from, to] in stretches.into_iter().flatten().filter(|[_, to]| *to > ray.t_min) {
            self.all.push((primitive.id, from));
            // What may lie behind the origin is not certain to be met.
            if is_certain && from > ray.t_min {
                self.end = self.end.min(to);
            }
        }
    }

    /// Certain is what is alone in coming first.
    fn verdict(&self, t_max: f64) -> Option<Option<PrimitiveId>> {
        let mut first = self.all.iter().filter(|(_, from)| *from <= self.end).map(|&(id, _)| id);
        let Some(id) = first.next() else { return Some(None) };
        let is_alone = self.end < t_max && first.all(|other| other == id);
        is_alone.then_some(Some(id))
    }
}

/// Up to two stretches of the ray where an engine may meet a primitive, on its near and its far side, and whether every
/// engine does.
pub(super) type Stretches = ([Option<[f64; 2]>; 2], bool);

fn stretches(primitive: &Primitive, ray: &Ray) -> Stretches {
    let departure = ray.departure.filter(|departure| departure.from == primitive.id);
    match (&primitive.shape, departure) {
        // A ray that starts on a sphere meets its far side alone, if it goes inside; one that starts on a face, nothing.
        (Shape::Sphere { center, radius }, Some(Departure { inward: true, .. })) => {
            let ([_, far], is_certain) = sphere(ray, *center, *radius);
            ([None, far], is_certain)
        }
        (_, Some(_)) => ([None; 2], false),
        (Shape::Sphere { center, radius }, None) => sphere(ray, *center, *radius),
        (Shape::Triangle { vertices, normal, .. }, None) => outline(ray, vertices, *normal),
        (Shape::Polygon { vertices, normal, .. }, None) => outline(ray, vertices, *normal),
    }
}

pub(super) fn sphere(ray: &Ray, center: DVec3, radius: f64) -> Stretches {
    let to_center = center - ray.origin;
    let band = band(ray.origin, to_center.length() + radius);
    let middle = to_center.dot(ray.direction);
    let distance = (to_center - middle * ray.direction).length();
    if distance > radius + band {
        return ([None; 2], false);
    }
    // Half the chord at the line moved outward and inward.
    let half_chord = |distance: f64| ((radius - distance) * (radius + distance)).max(0.0).sqrt();
    let shortest = half_chord(distance + band) - band;
    let longest = half_chord((distance - band).max(0.0)) + band;
    let sides = [[middle - longest, middle - shortest], [middle + shortest, middle + longest]];
    (sides.map(Some), distance < radius - band)
}

/// A triangle or a polygon. Of one that is not quite plane, the outline as seen from the ray counts, as everywhere.
pub(super) fn outline(ray: &Ray, vertices: &[DVec3], normal: DVec3) -> Stretches {
    let (x, y) = ray.direction.any_orthonormal_pair();
    let farthest = vertices.iter().map(|&vertex| vertex.distance(ray.origin)).fold(0.0, f64::max);
    let band = band(ray.origin, farthest);
    // The ray is seen end on, as the point (0, 0).
    let seen = |vertex: DVec3| {
        let from_origin = vertex - ray.origin;
        DVec3::new(from_origin.dot(x), from_origin.dot(y), from_origin.dot(ray.direction))
    };
    let mut from = seen(vertices[vertices.len() - 1]);
    let (mut is_inside, mut to_edge) = (false, f64::INFINITY);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &vertex in vertices {
        let to = seen(vertex);
        let is_crossed = (from.y < 0.0) != (to.y < 0.0);
        is_inside ^= is_crossed && (from.xy().perp_dot(to.xy()) > 0.0) == (to.y > from.y);
        to_edge = to_edge.min(distance_to_segment(from.xy(), to.xy()));
        (low, high) = (low.min(to.z), high.max(to.z));
        from = to;
    }
    if !is_inside && to_edge > band {
        return ([None; 2], false);
    }
    let slope = normal.dot(ray.direction);
    let t = normal.dot(vertices[0] - ray.origin) / slope;
    let slack = band / slope.abs();
    // Edge-on, t or t ± slack may be no number; max and min pass over that, and the outline alone bounds t.
    let (low, high) = (low - band, high + band);
    let stretch = [(t - slack).max(low).min(high), (t + slack).min(high).max(low)];
    ([Some(stretch), None], is_inside && to_edge > band)
}

/// From (0, 0).
fn distance_to_segment(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let share = if length_squared > 0.0 { (-a.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (a + share * along).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Geometry, Material, MaterialId};
    use glam::Vec3;

    const GREY: MaterialId = MaterialId(0);

    fn hierarchy(geometry: &Geometry) -> Hierarchy {
        Hierarchy::new(Primitive::all(geometry, &[Material::grey()]))
    }

    fn add_square(geometry: &mut Geometry, low: f32, high: f32, z: f32) {
        let corners = [[low, low], [high, low], [high, high], [low, high]];
        geometry.add_polygon(&corners.map(|[x, y]| Vec3::new(x, y, z)), None, GREY).unwrap();
    }

    fn add_triangle(geometry: &mut Geometry, corners: [[f32; 3]; 3]) {
        let first = geometry.add_vertices(corners.map(Vec3::from)).unwrap();
        geometry.add_triangle([first, first + 1, first + 2], None, GREY).unwrap();
    }

    /// Straight down from height 5.
    fn down(x: f64, y: f64) -> Ray {
        Ray::new(DVec3::new(x, y, 5.0), DVec3::NEG_Z, None)
    }

    const MISS: Option<Option<PrimitiveId>> = Some(None);

    fn hits(id: u32) -> Option<Option<PrimitiveId>> {
        Some(Some(PrimitiveId(id)))
    }

    /// Rays beside the point (x, y) of an outline whose outside lies along +x, by so many bands.
    #[track_caller]
    fn assert_band(geometry: &Geometry, [x, y]: [f64; 2], farthest: f64) {
        let hierarchy = hierarchy(geometry);
        let band = band(down(x, y).origin, farthest);
        for (bands, expected) in [
            (-1e5, hits(0)),
            (-2.0, hits(0)),
            (-1.01, hits(0)),
            (-0.99, None),
            (0.0, None),
            (0.99, None),
            (1.01, MISS),
            (2.0, MISS),
            (1e5, MISS),
        ] {
            let found = certain_hit(&hierarchy, &down(x + bands * band, y), f64::INFINITY);
            assert_eq!(found, expected, "{bands} bands outside");
        }
    }

    #[test]
    fn the_edge_of_a_polygon_is_uncertain_by_the_band() {
        let mut geometry = Geometry::default();
        add_square(&mut geometry, -1.0, 1.0, 0.0);
        let farthest = DVec3::new(2.0, 1.25, 5.0).length();
        assert_band(&geometry, [1.0, 0.25], farthest);
    }

    #[test]
    fn the_edge_of_a_triangle_is_uncertain_by_the_band() {
        let mut geometry = Geometry::default();
        add_triangle(&mut geometry, [[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]);
        let farthest = DVec3::new(2.0, 0.25, 5.0).length();
        assert_band(&geometry, [1.0, 0.25], farthest);
    }

    #[test]
    fn the_limb_of_a_sphere_is_uncertain_by_the_band() {
        let mut geometry = Geometry::default();
        geometry.add_sphere(Vec3::ZERO, 1.0, GREY).unwrap();
        assert_band(&geometry, [1.0, 0.0], DVec3::new(1.0, 0.0, 5.0).length() + 1.0);
    }

    #[test]
    fn the_corner_of_a_concave_polygon_is_uncertain_and_the_line_beyond_an_edge_is_not() {
        let mut geometry = Geometry::default();
        // An L: the square without its upper right quarter.
        let corners = [[-1, -1], [1, -1], [1, 0], [0, 0], [0, 1], [-1, 1]];
        let corners = corners.map(|[x, y]: [i8; 2]| Vec3::new(f32::from(x), f32::from(y), 0.0));
        geometry.add_polygon(&corners, None, GREY).unwrap();
        let hierarchy = hierarchy(&geometry);
        assert_eq!(certain_hit(&hierarchy, &down(0.0, 0.0), f64::INFINITY), None);
        assert_eq!(certain_hit(&hierarchy, &down(0.0, -0.5), f64::INFINITY), hits(0));
        assert_eq!(certain_hit(&hierarchy, &down(-0.5, 0.0), f64::INFINITY), hits(0));
        assert_eq!(certain_hit(&hierarchy, &down(0.5, 0.5), f64::INFINITY), MISS);
    }

    #[test]
    fn a_common_edge_is_uncertain_unless_something_hides_it() {
        let mut geometry = Geometry::default();
        add_triangle(&mut geometry, [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]);
        add_triangle(&mut geometry, [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]);
        let open = hierarchy(&geometry);
        assert_eq!(certain_hit(&open, &down(0.25, 0.25), f64::INFINITY), None);
        assert_eq!(certain_hit(&open, &down(0.25, 0.24), f64::INFINITY), hits(0));
        assert_eq!(certain_hit(&open, &down(0.25, 0.26), f64::INFINITY), hits(1));
        add_square(&mut geometry, -2.0, 2.0, 1e-5);
        assert_eq!(certain_hit(&hierarchy(&geometry), &down(0.25, 0.25), f64::INFINITY), hits(2));
    }

    #[test]
    fn surfaces_in_one_place_are_uncertain_where_they_overlap() {
        let apart = |z: f64| {
            let mut geometry = Geometry::default();
            add_square(&mut geometry, -1.0, 1.0, 0.0);
            #[expect(clippy::cast_possible_truncation, reason = "a number of few digits")]
            add_square(&mut geometry, -0.5, 2.0, z as f32);
            let hierarchy = hierarchy(&geometry);
            assert_eq!(certain_hit(&hierarchy, &down(-0.75, 0.0), f64::INFINITY), hits(0));
            assert_eq!(certain_hit(&hierarchy, &down(1.5, 0.0), f64::INFINITY), hits(1));
            certain_hit(&hierarchy, &down(0.0, 0.0), f64::INFINITY)
        };
        // Met head-on, t is uncertain by the bands, 45 and 49 of 2⁻²⁴.
        assert_eq!([0.0, 50.0 * U, -50.0 * U].map(apart), [None; 3]);
        assert_eq!([150.0 * U, -150.0 * U].map(apart), [hits(1), hits(0)]);
    }

    #[test]
    fn what_is_seen_edge_on_is_uncertain() {
        let mut geometry = Geometry::default();
        add_triangle(&mut geometry, [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let tower = hierarchy(&geometry);
        assert_eq!(certain_hit(&tower, &down(0.0, 0.1), f64::INFINITY), None);
        assert_eq!(certain_hit(&tower, &down(1e-5, 0.1), f64::INFINITY), MISS);
        // What is before it is seen for certain, what is behind it is not.
        add_square(&mut geometry, -2.0, 2.0, 1.5);
        assert_eq!(certain_hit(&hierarchy(&geometry), &down(0.0, 0.1), f64::INFINITY), hits(1));
        let from_below = Ray::new(DVec3::new(0.0, 0.1, -5.0), DVec3::Z, None);
        assert_eq!(certain_hit(&hierarchy(&geometry), &from_below, f64::INFINITY), None);
    }

    #[test]
    fn what_the_ray_starts_on_is_uncertain_and_what_is_behind_it_is_not_seen() {
        let mut geometry = Geometry::default();
        add_square(&mut geometry, -1.0, 1.0, 5.0);
        assert_eq!(certain_hit(&hierarchy(&geometry), &down(0.0, 0.0), f64::INFINITY), None);
        let mut geometry = Geometry::default();
        add_square(&mut geometry, -1.0, 1.0, 6.0);
        geometry.add_sphere(Vec3::new(0.0, 0.0, 7.0), 1.0, GREY).unwrap();
        assert_eq!(certain_hit(&hierarchy(&geometry), &down(0.0, 0.0), f64::INFINITY), MISS);
        // From inside a sphere its far side is met.
        geometry.add_sphere(Vec3::new(0.0, 0.0, 5.0), 0.5, GREY).unwrap();
        assert_eq!(certain_hit(&hierarchy(&geometry), &down(0.0, 0.0), f64::INFINITY), hits(2));
    }

    /// Numbers in [-1, 1] of no pattern.
    fn noise(count: &mut u32) -> f64 {
        *count += 1;
        (f64::from(*count) * 12.9898).sin() * 43758.5453 % 1.0
    }

    fn noise3(count: &mut u32) -> DVec3 {
        DVec3::new(noise(count), noise(count), noise(count))
    }

    fn heap() -> (Geometry, u32) {
        let (mut geometry, mut count) = (Geometry::default(), 0);
        for _ in 0..60 {
            let center = noise3(&mut count);
            geometry.add_sphere(center.as_vec3(), 0.05, GREY).unwrap();
            let corners = [0; 3].map(|_| (center + 0.3 * noise3(&mut count)).as_vec3().to_array());
            add_triangle(&mut geometry, corners);
        }
        (geometry, count)
    }

    #[test]
    fn the_hierarchy_leaves_out_nothing_that_counts() {
        let (geometry, mut count) = heap();
        let (hierarchy, all) = (hierarchy(&geometry), Primitive::all(&geometry, &[Material::grey()]));
        for _ in 0..2000 {
            // Every other ray aims at a vertex, where it is uncertain.
            let vertex = geometry.vertices[count as usize % geometry.vertices.len()].as_dvec3();
            let target = if count % 2 == 0 { vertex } else { noise3(&mut count) };
            let origin = 4.0 * noise3(&mut count);
            let ray = Ray::new(origin, (target - origin).normalize(), None);
            let mut sightings = Sightings::NONE;
            all.iter().for_each(|primitive| sightings.add(primitive, &ray));
            assert_eq!(certain_hit(&hierarchy, &ray, f64::INFINITY), sightings.verdict(f64::INFINITY));
        }
    }

    /// Certain means the same closest hit for every ray that rounding may make of this one.
    #[test]
    fn what_is_certain_does_not_turn_on_the_rounding_of_the_ray() {
        let (geometry, mut count) = heap();
        let hierarchy = hierarchy(&geometry);
        let id = |ray: &Ray| hierarchy.closest(ray).map(|hit| hit.primitive.id);
        let (mut certain, mut changed) = (0, 0);
        for _ in 0..4000 {
            let triangle = &geometry.triangles[count as usize % geometry.triangles.len()];
            let [a, b, _] = triangle.vertices.map(|index| geometry.vertices[index as usize].as_dvec3());
            let origin = 4.0 * noise3(&mut count);
            // Aimed past an edge by up to two bands.
            let past = 2.0 * band(origin, 5.0) * noise3(&mut count);
            let direction = (a.lerp(b, noise(&mut count).abs()) + past - origin).normalize();
            let ray = Ray::new(origin, direction, None);
            let verdict = certain_hit(&hierarchy, &ray, f64::INFINITY);
            certain += u32::from(verdict.is_some());
            for _ in 0..8 {
                let moved = Ray::new(
                    origin + U * origin * noise3(&mut count),
                    (direction + U * noise3(&mut count)).normalize(),
                    None,
                );
                match verdict {
                    Some(verdict) => assert_eq!(id(&moved), verdict),
                    None => changed += u32::from(id(&moved) != id(&ray)),
                }
            }
        }
        assert!(certain > 500 && changed > 100, "{certain} certain, {changed} changed");
    }

    /// The closest hit in f32 with the usual formulas: what an engine may honestly answer.
    fn single(geometry: &Geometry, ray: &Ray) -> Option<PrimitiveId> {
        let (origin, direction) = (ray.origin.as_vec3(), ray.direction.as_vec3());
        let spheres = geometry.spheres.iter().filter_map(|sphere| {
            let from_center = origin - sphere.center;
            let middle = -from_center.dot(direction);
            let distance = (from_center + middle * direction).length();
            let half_chord_squared = (sphere.radius - distance) * (sphere.radius + distance);
            let half_chord = half_chord_squared.sqrt();
            let near = middle - half_chord;
            let t = if near > 0.0 { near } else { middle + half_chord };
            (half_chord_squared >= 0.0).then_some((t, sphere.id))
        });
        let z = direction.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let triangles = geometry.triangles.iter().filter_map(|triangle| {
            let [a, b, c] = triangle.vertices.map(|index| {
                let v = geometry.vertices[index as usize] - origin;
                let share = v[z] / direction[z];
                Vec3::new(v[x] - direction[x] * share, v[y] - direction[y] * share, share)
            });
            let area = |a: Vec3, b: Vec3| a.x * b.y - a.y * b.x;
            let (u, v, w) = (area(b, c), area(c, a), area(a, b));
            let is_hit = u.min(v).min(w) >= 0.0 || u.max(v).max(w) <= 0.0;
            is_hit.then(|| ((u * a.z + v * b.z + w * c.z) / (u + v + w), triangle.id))
        });
        let hits = spheres.chain(triangles).filter(|(t, _)| *t > 0.0);
        hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    }

    #[test]
    fn what_is_certain_is_seen_by_an_engine_in_f32() {
        let (geometry, mut count) = heap();
        let hierarchy = hierarchy(&geometry);
        let (mut certain, mut different) = (0, 0);
        for step in 0..40_000 {
            let origin = (4.0 * noise3(&mut count)).as_vec3().as_dvec3();
            let past = 1.2 * band(origin, 5.0) * noise3(&mut count);
            // At an edge, and at what is about a limb.
            let target = if step % 2 == 0 {
                let triangle = &geometry.triangles[count as usize % geometry.triangles.len()];
                let [a, b, _] = triangle.vertices.map(|index| geometry.vertices[index as usize].as_dvec3());
                a.lerp(b, noise(&mut count).abs())
            } else {
                let sphere = &geometry.spheres[count as usize % geometry.spheres.len()];
                let to_center = sphere.center.as_dvec3() - origin;
                let (radius, distance) = (f64::from(sphere.radius), to_center.length());
                let aside = to_center.cross(noise3(&mut count)).normalize();
                // The point of the limb in that direction.
                let sine = radius / distance;
                let along = to_center - radius * sine * to_center / distance;
                origin + along + radius * (1.0 - sine * sine).sqrt() * aside
            };
            let ray = Ray::new(origin, (target + past - origin).normalize(), None);
            let found = single(&geometry, &ray);
            match certain_hit(&hierarchy, &ray, f64::INFINITY) {
                Some(verdict) => {
                    certain += 1;
                    assert_eq!(found, verdict, "{ray:?}");
                }
                None => {
                    let truth = hierarchy.closest(&ray).map(|hit| hit.primitive.id);
                    different += u32::from(found != truth);
                }
            }
        }
        assert!(certain > 5000 && different > 200, "{certain} certain, {different} different");
    }
}
