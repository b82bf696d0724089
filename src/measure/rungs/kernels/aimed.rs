//! Rays from the eye that are aimed at what faces share: points of their common edges, and common corners.

use crate::kernel::UNIT_ROUNDOFF;
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::scene::Geometry;
use crate::trace::RayColumns;
use crate::traverse::SingleRay;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Triangles or polygons that share points by their places: files often write a corner once for each face.
pub(super) struct Mesh {
    points: Vec<Vec3>,
    /// Numbers of points, face by face.
    corners: Vec<u32>,
    /// Of each face, in its column of the scene's geometry.
    faces: Vec<Range<usize>>,
}

/// A point to aim at and the faces that meet there.
pub(super) struct Target {
    at: DVec3,
    faces: Vec<u32>,
    /// What the faces share: the ends of an edge, or a corner twice.
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
    pub(super) fn of_triangles(geometry: &Geometry) -> Self {
        Self::new(geometry, geometry.triangles.iter().map(|triangle| triangle.vertices))
    }

    pub(super) fn of_polygons(geometry: &Geometry) -> Self {
        Self::new(geometry, geometry.polygons.iter().map(|polygon| polygon.vertices.clone()))
    }

    fn new(geometry: &Geometry, faces: impl Iterator<Item = impl IntoIterator<Item = u32>>) -> Self {
        let mut numbers = HashMap::new();
        let mut this = Self { points: Vec::new(), corners: Vec::new(), faces: Vec::new() };
        for face in faces {
            let first = this.corners.len();
            for index in face {
                // Both zeros are one.
                let point = geometry.vertices[index as usize] + Vec3::ZERO;
                this.corners.push(*numbers.entry(point.to_array().map(f32::to_bits)).or_insert_with(|| {
                    this.points.push(point);
                    word(this.points.len() - 1)
                }));
            }
            this.faces.push(first..this.corners.len());
        }
        this
    }

    fn point(&self, number: u32) -> DVec3 {
        self.points[number as usize].as_dvec3()
    }

    /// Edges of a face, in its order.
    fn edges_of(&self, face: u32) -> impl Iterator<Item = [u32; 2]> {
        let corners = &self.corners[self.faces[face as usize].clone()];
        corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&from, &to)| [from, to])
    }

    /// At points of edges that two faces share: all of the same number for each edge, or of edges evenly taken.
    pub(super) fn edges(&self) -> Vec<Target> {
        let mut edges: Vec<([u32; 2], u32)> = Vec::with_capacity(self.corners.len());
        for face in 0..word(self.faces.len()) {
            edges.extend(self.edges_of(face).map(|[a, b]| ([a.min(b), a.max(b)], face)));
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
                faces: edge.iter().map(|&(_, face)| face).collect(),
                shared: ends,
            })
        });
        targets.collect()
    }

    /// At corners that faces share, evenly taken.
    pub(super) fn corners(&self) -> Vec<Target> {
        let stride = self.points.len().div_ceil(MOST_RAYS).max(1);
        let mut at_point = vec![Vec::new(); self.points.len().div_ceil(stride)];
        for (face, corners) in (0..).zip(&self.faces) {
            for point in self.corners[corners.clone()].iter().map(|&point| point as usize) {
                if point.is_multiple_of(stride) {
                    at_point[point / stride].push(face);
                }
            }
        }
        let targets = at_point.into_iter().enumerate().map(|(place, faces)| {
            let point = word(place * stride);
            Target { at: self.point(point), faces, shared: [point; 2] }
        });
        targets.collect()
    }

    /// Rays to targets, but for those that could honestly pass all faces of their target by: each with these faces.
    pub(super) fn aim(
        &self,
        prepared: &Prepared<'_>,
        targets: &[Target],
        mut visit: impl FnMut(&SingleRay, &[u32]),
    ) {
        let eye = prepared.scene.camera.eye;
        let row = |target: &Target| {
            let [ox, oy, oz] = eye.to_array();
            // Rounded to f32 once, at the target and again on the way to it.
            let [dx, dy, dz] = (target.at.as_vec3().as_dvec3() - eye.as_dvec3()).as_vec3().to_array();
            [ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]
        };
        let set = RaySet { rows: targets.iter().map(row).collect(), ..RaySet::default() };
        let columns = RayColumns::new(prepared, &set);
        let rays = columns.rays();
        for (row, target) in targets.iter().enumerate() {
            let Some(stretch) = set.stretch(row) else { continue };
            if self.surrounds(target, stretch.origin, stretch.direction) {
                visit(&SingleRay::new(&prepared.hierarchy, &rays, row), &target.faces);
            }
        }
    }

    /// The corners of a triangle, in the scale of the prepared scene.
    pub(super) fn triangle(&self, prepared: &Prepared<'_>, face: u32) -> [[f32; 3]; 3] {
        let first = self.faces[face as usize].start;
        [0, 1, 2].map(|corner| {
            let point = self.points[self.corners[first + corner] as usize];
            prepared.scale.position(point).to_array()
        })
    }

    /// Whether the faces of a target, as seen along a ray at it, lie all around it, with their outer edges farther from the
    /// ray than rounding reaches. Then the ray hits one of them, whichever way it is rounded.
    fn surrounds(&self, target: &Target, origin: DVec3, direction: DVec3) -> bool {
        let (x, y) = direction.normalize().any_orthonormal_pair();
        let seen = |point: u32| {
            let from_origin = self.point(point) - origin;
            DVec2::new(from_origin.dot(x), from_origin.dot(y))
        };
        let is_shared = |point: u32| target.shared.contains(&point);
        let is_edge = target.shared[0] != target.shared[1];
        let mut farthest = 0.0_f64;
        // Edges that run into what is shared, each with the side of it that the face is on: at an inner edge there are two.
        let mut inner: Vec<([u32; 2], bool)> = Vec::new();
        let mut nearest_outer = f64::INFINITY;
        for &face in &target.faces {
            let double_area: f64 = self.edges_of(face).map(|[from, to]| seen(from).perp_dot(seen(to))).sum();
            for [from, to] in self.edges_of(face) {
                farthest = farthest.max(self.point(from).distance(origin));
                let is_inner =
                    if is_edge { is_shared(from) && is_shared(to) } else { is_shared(from) || is_shared(to) };
                if is_inner {
                    inner.push(([from.min(to), from.max(to)], (double_area > 0.0) == (from < to)));
                } else {
                    nearest_outer = nearest_outer.min(distance_from_segment(seen(from), seen(to)));
                }
            }
        }
        inner.sort_unstable();
        let is_closed = inner.chunk_by(|a, b| a.0 == b.0).all(|edge| {
            let [(_, one), (_, other)] = edge else { return false };
            one != other
        });
        is_closed && nearest_outer > MARGIN * farthest
    }
}

/// Vertices and faces are fewer than 2³².
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
