//! A `t_min` for tracers that do not know where a ray starts.
//!
//! The engine knows the primitive that a ray starts on, and never hits it by rounding. Other tracers are told by `t_min`
//! where to begin: beyond what rounding makes of the surface's distance, and not much beyond.

use crate::rays::RaySet;
use crate::scene::{Geometry, PrimitiveId, polygon_normal};
use glam::DVec3;

/// Roundings of 2⁻²⁴ of the coordinates that a tracer in f32 is allowed.
const ROUNDINGS: f64 = 32.0 / (1 << 24) as f64;

/// No start is moved farther than this share of the scene's size, at however shallow an angle.
const LARGEST_SHARE: f64 = 1.0 / 1024.0;

/// Gives rays that start on primitives their `t_min`.
///
/// With h the distance of the start from the surface and L the largest coordinate that takes part, a tracer may see the
/// surface at t ≤ (h + ROUNDINGS·L) / (|d|·cos θ).
pub fn add_clearance(geometry: &Geometry, rays: &mut RaySet) {
    let Some((low, high)) = geometry.bounds() else { return };
    let most = LARGEST_SHARE * low.distance(high);
    for row in 0..rays.starts.len() {
        let Some(stretch) = rays.stretch(row) else { continue };
        let departure = rays.starts[row].departure;
        let [x, y, z, ..] = rays.rows[row].map(f64::from);
        // As others will have it: without what rounding to f32 left out.
        let origin = DVec3::new(x, y, z);
        let Some(surface) = Surface::of(geometry, departure.from, origin) else { continue };
        let off = surface.height.abs() + ROUNDINGS * origin.abs().max_element().max(surface.extent);
        let speed = stretch.direction.length();
        let cosine = surface.normal.dot(stretch.direction / speed).abs();
        // Of a chord through a sphere, 2r·cos θ, half is left: its end is a hit.
        let along = (off / cosine).min(most).min(surface.radius * cosine);
        #[expect(clippy::cast_possible_truncation, reason = "rounded up by the next line")]
        let t_min = (along / speed) as f32;
        rays.rows[row][3] = t_min.next_up();
    }
}

/// A primitive as a point near it sees it.
struct Surface {
    /// Unit.
    normal: DVec3,
    /// Of the point above it.
    height: f64,
    /// Infinite for a face.
    radius: f64,
    /// Its largest coordinate.
    extent: f64,
}

impl Surface {
    fn of(geometry: &Geometry, id: PrimitiveId, point: DVec3) -> Option<Self> {
        if let Ok(index) = geometry.spheres.binary_search_by_key(&id, |sphere| sphere.id) {
            let sphere = &geometry.spheres[index];
            let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
            let (normal, distance) = (point - center).normalize_and_length();
            let extent = center.abs().max_element() + radius;
            return Some(Self { normal, height: distance - radius, radius, extent });
        }
        let corner = |index: u32| geometry.vertices[index as usize].as_dvec3();
        if let Ok(index) = geometry.triangles.binary_search_by_key(&id, |triangle| triangle.id) {
            return Self::of_face(&geometry.triangles[index].vertices.map(corner), point);
        }
        let index = geometry.polygons.binary_search_by_key(&id, |polygon| polygon.id).ok()?;
        Self::of_face(&geometry.polygons[index].vertices.clone().map(corner).collect::<Vec<_>>(), point)
    }

    fn of_face(corners: &[DVec3], point: DVec3) -> Option<Self> {
        let normal = polygon_normal(corners)?;
        let extent = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        Some(Self { normal, height: normal.dot(point - corners[0]), radius: f64::INFINITY, extent })
    }
}
