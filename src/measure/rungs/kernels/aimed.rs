//! Rays from the eye that are aimed at what triangles share: points of their common edges, and common corners.

use super::columns::Columns;
use super::pairs::triangle_pair;
use crate::kernel::UNIT_ROUNDOFF;
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::scene::Geometry;
use crate::trace::RayColumns;
use crate::traverse::SingleRay;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Rays and the triangles around what each is aimed at.
pub(super) struct Aimed {
    pub(super) pairs: Columns<18>,
    /// The pairs of each ray.
    pub(super) rays: Vec<Range<usize>>,
}

/// A mesh whose triangles share points by their places: files often write a corner once for each triangle.
pub(super) struct Mesh {
    points: Vec<Vec3>,
    /// By numbers of points.
    triangles: Vec<[u32; 3]>,
}

/// A point to aim at and the triangles that meet there.
struct Target {
    at: DVec3,
    triangles: Vec<u32>,
    /// What the triangles share: the ends of an edge, or a corner twice.
    shared: [u32; 2],
}

/// Rays of a class, at most.
const MOST_RAYS: usize = 1 << 17;
/// Points of an edge that are aimed at, at most.
const MOST_POINTS: usize = 16;

/// What is nearer to a ray than this share of the distance may be on its other side after rounding: twice the band within
/// which an honest test of an edge may be wrong, rounded up.
const MARGIN: f64 = 32.0 * UNIT_ROUNDOFF as f64;

impl Mesh {
    pub(super) fn new(geometry: &Geometry) -> Self {
        let mut numbers = HashMap::new();
        let mut points = Vec::new();
        let mut number = |index: u32| {
            // Both zeros are one.
            let point = geometry.vertices[index as usize] + Vec3::ZERO;
            *numbers.entry(point.to_array().map(f32::to_bits)).or_insert_with(|| {
                points.push(point);
                word(points.len() - 1)
            })
        };
        let triangles =
            geometry.triangles.iter().map(|triangle| triangle.vertices.map(&mut number)).collect();
        Self { points, triangles }
    }

    fn point(&self, number: u32) -> DVec3 {
        self.points[number as usize].as_dvec3()
    }

    /// At points of edges that two triangles share: all of the same number for each edge, or of edges evenly taken.
    pub(super) fn edges(&self, prepared: &Prepared<'_>) -> Aimed {
        let mut edges: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * self.triangles.len());
        for (triangle, &[a, b, c]) in (0..).zip(&self.triangles) {
            edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], triangle)));
        }
        edges.sort_unstable();
        let shared: Vec<_> = edges.chunk_by(|a, b| a.0 == b.0).filter(|edge| edge.len() == 2).collect();
        let points = (MOST_RAYS / shared.len().max(1)).clamp(1, MOST_POINTS);
        let stride = shared.len().div_ceil(MOST_RAYS).max(1);
        let targets = shared.into_iter().step_by(stride).flat_map(|edge| {
            let ends = edge[0].0;
            let [from, to] = ends.map(|point| self.point(point));
            (0..points).map(move |point| Target {
                at: from.lerp(to, (point as f64 + 0.5) / points as f64),
                triangles: edge.iter().map(|&(_, triangle)| triangle).collect(),
                shared: ends,
            })
        });
        self.aimed(prepared, &targets.collect::<Vec<_>>())
    }

    /// At corners that triangles share, evenly taken.
    pub(super) fn corners(&self, prepared: &Prepared<'_>) -> Aimed {
        let stride = self.points.len().div_ceil(MOST_RAYS).max(1);
        let mut at_point = vec![Vec::new(); self.points.len().div_ceil(stride)];
        for (triangle, corners) in (0..).zip(&self.triangles) {
            for point in corners.map(|point| point as usize) {
                if point.is_multiple_of(stride) {
                    at_point[point / stride].push(triangle);
                }
            }
        }
        let targets = at_point.into_iter().enumerate().map(|(place, triangles)| {
            let point = word(place * stride);
            Target { at: self.point(point), triangles, shared: [point; 2] }
        });
        self.aimed(prepared, &targets.collect::<Vec<_>>())
    }

    /// Rays to targets, but for those that could honestly pass all triangles of their target by.
    fn aimed(&self, prepared: &Prepared<'_>, targets: &[Target]) -> Aimed {
        let eye = prepared.scene.camera.eye;
        let row = |target: &Target| {
            let [ox, oy, oz] = eye.to_array();
            // Rounded to f32 once, at the target and again on the way to it.
            let [dx, dy, dz] = (target.at.as_vec3().as_dvec3() - eye.as_dvec3()).as_vec3().to_array();
            [ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]
        };
        let set = RaySet { rows: targets.iter().map(row).collect(), ..RaySet::default() };
        let columns = RayColumns::new(prepared, &set);
        let rays = columns.rays(&(0..columns.filled()));
        let mut aimed = Aimed { pairs: Columns::new(), rays: Vec::new() };
        for (row, target) in targets.iter().enumerate() {
            let Some(stretch) = set.stretch(row) else { continue };
            if !self.surrounds(target, stretch.origin, stretch.direction) {
                continue;
            }
            let ray = SingleRay::new(&prepared.hierarchy, &rays, row);
            let first = aimed.pairs.len();
            for &triangle in &target.triangles {
                let corners = self.triangles[triangle as usize];
                let vertices =
                    corners.map(|point| prepared.scale.position(self.points[point as usize]).to_array());
                aimed.pairs.push(triangle_pair(&ray, vertices));
            }
            aimed.rays.push(first..aimed.pairs.len());
        }
        aimed
    }

    /// Whether the triangles of a target, as seen along a ray at it, lie all around it, with their outer edges farther from the
    /// ray than rounding reaches. Then the ray hits one of them, whichever way it is rounded.
    fn surrounds(&self, target: &Target, origin: DVec3, direction: DVec3) -> bool {
        let (x, y) = direction.normalize().any_orthonormal_pair();
        let seen = |point: u32| {
            let from_origin = self.point(point) - origin;
            DVec2::new(from_origin.dot(x), from_origin.dot(y))
        };
        let is_shared = |point: u32| target.shared.contains(&point);
        let mut farthest = 0.0_f64;
        // Edges that run into what is shared, each with the corner across: at an inner edge there are two, on either side.
        let mut inner: Vec<([u32; 2], DVec2)> = Vec::new();
        let mut nearest_outer = f64::INFINITY;
        for &triangle in &target.triangles {
            let [a, b, c] = self.triangles[triangle as usize];
            for ([from, to], across) in [([a, b], c), ([b, c], a), ([c, a], b)] {
                farthest = farthest.max(self.point(from).distance(origin));
                let is_edge = target.shared[0] != target.shared[1];
                let is_inner =
                    if is_edge { is_shared(from) && is_shared(to) } else { is_shared(from) || is_shared(to) };
                if is_inner {
                    inner.push(([from.min(to), from.max(to)], seen(across)));
                } else {
                    nearest_outer = nearest_outer.min(distance_from_segment(seen(from), seen(to)));
                }
            }
        }
        inner.sort_unstable_by_key(|(edge, _)| *edge);
        let is_closed = inner.chunk_by(|a, b| a.0 == b.0).all(|edge| {
            let [([from, to], one), (_, other)] = edge else { return false };
            let (from, along) = (seen(*from), seen(*to) - seen(*from));
            along.perp_dot(*one - from) * along.perp_dot(*other - from) < 0.0
        });
        is_closed && nearest_outer > MARGIN * farthest
    }
}

/// Vertices and triangles are fewer than 2³².
fn word(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

/// From (0, 0), where the ray is.
fn distance_from_segment(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let share = if length_squared > 0.0 { (-a.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (a + share * along).length()
}
