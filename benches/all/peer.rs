//! The baseline from Rust's crates: obvhs, its CWBVH over triangles in the order of its leaves, as its own examples have it.
//! One ray at a time is all that it offers.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use std::time::Duration;
use wavelane::rays::RaySet;
use wavelane::scene::Geometry;
use wavelane::trace::Hits;

/// Triangles in its form.
pub(crate) struct Triangles {
    corners: Vec<Triangle>,
    /// Their ids in the scene.
    ids: Vec<u32>,
}

impl Triangles {
    pub(crate) fn of(geometry: &Geometry) -> Self {
        let corner = |index: u32| Vec3A::from(geometry.vertices[index as usize]);
        let triangle = |[v0, v1, v2]: [Vec3A; 3]| Triangle { v0, v1, v2 };
        Self {
            corners: geometry.triangles.iter().map(|each| triangle(each.vertices.map(corner))).collect(),
            ids: geometry.triangles.iter().map(|each| each.id.0).collect(),
        }
    }
}

/// A tree of obvhs.
pub(crate) struct Peer {
    bvh: CwBvh,
    /// In the order of the tree's leaves, like their ids.
    triangles: Vec<RtTriangle>,
    ids: Vec<u32>,
}

impl Peer {
    /// All that it takes to go from triangles to tracing, on this thread.
    pub(crate) fn build(triangles: &Triangles, parameters: BvhBuildParams) -> Self {
        let Triangles { corners, ids } = triangles;
        let bvh = build_cwbvh_from_tris(corners, parameters, &mut Duration::default());
        let order = || bvh.primitive_indices.iter().map(|&index| index as usize);
        let triangles = order().map(|index| RtTriangle::from(&corners[index])).collect();
        let ids = order().map(|index| ids[index]).collect();
        Self { bvh, triangles, ids }
    }

    /// The closest hit of each ray, one after the other.
    pub(crate) fn trace(&self, rays: &RaySet, hits: &mut Hits) {
        let ends = hits.t.iter_mut().zip(&mut hits.id);
        for (&[ox, oy, oz, t_min, dx, dy, dz, t_max], (t, id)) in rays.rows.iter().zip(ends) {
            let ray = Ray::new(Vec3A::new(ox, oy, oz), Vec3A::new(dx, dy, dz), t_min, t_max);
            let mut hit = RayHit::none();
            let is_hit =
                self.bvh.ray_traverse(ray, &mut hit, |ray, index| self.triangles[index].intersect(ray));
            (*t, *id) = if is_hit {
                (hit.t, self.ids[hit.primitive_id as usize])
            } else {
                (f32::INFINITY, Hits::MISS)
            };
        }
    }
}
