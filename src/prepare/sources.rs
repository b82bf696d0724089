//! From the scene's columns to the builder's items, and from its leaves back to the columns.

use super::Scale;
use super::blocks::{SphereBlock, TriangleBlock};
use super::bvh::{Bounds, Item, Kind, Leaf};
use crate::lanes::prefetch;
use crate::scene::Geometry;
use glam::Vec3;

/// Primitives by one index: first the spheres, then the triangles, then the polygons.
#[derive(Clone, Copy)]
pub(super) struct Sources<'a> {
    pub(super) geometry: &'a Geometry,
    pub(super) scale: Scale,
}

impl Sources<'_> {
    /// Indices before those of a kind.
    fn before(&self, kind: Kind) -> usize {
        match kind {
            Kind::Sphere => 0,
            Kind::Triangle => self.geometry.spheres.len(),
            Kind::Polygon => self.geometry.spheres.len() + self.geometry.triangles.len(),
        }
    }

    pub(super) fn item(&self, index: usize) -> Item {
        let (triangles, polygons) = (self.before(Kind::Triangle), self.before(Kind::Polygon));
        if index < triangles {
            Item { bounds: self.sphere_bounds(index), kind: Kind::Sphere, weight: 1 }
        } else if index < polygons {
            let bounds = bounds_of(&self.corners(self.geometry.triangles[index - triangles].vertices));
            Item { bounds, kind: Kind::Triangle, weight: 1 }
        } else {
            let polygon = &self.geometry.polygons[index - polygons];
            let corners =
                &self.geometry.vertices[polygon.vertices.start as usize..polygon.vertices.end as usize];
            let bounds = corners.iter().fold(Bounds::EMPTY, |bounds, &corner| {
                let corner = self.scale.position(corner);
                bounds.union(Bounds { low: corner, high: corner })
            });
            let weight = u16::try_from(corners.len()).unwrap_or(u16::MAX);
            Item { bounds, kind: Kind::Polygon, weight }
        }
    }

    fn sphere_bounds(&self, index: usize) -> Bounds {
        let sphere = &self.geometry.spheres[index];
        bounds_of_sphere(self.scale.position(sphere.center), self.scale.length(sphere.radius))
    }

    fn corners(&self, vertices: [u32; 3]) -> [Vec3; 3] {
        vertices.map(|index| self.scale.position(self.geometry.vertices[index as usize]))
    }
}

fn bounds_of_sphere(center: Vec3, radius: f32) -> Bounds {
    // Outward by a rounding or two: the sum of centre and radius may round to the wrong side of the surface.
    let (low, high) = (center - radius, center + radius);
    let rounding = |end: Vec3| end.abs() * f32::EPSILON + f32::MIN_POSITIVE;
    Bounds { low: low - rounding(low), high: high + rounding(high) }
}

pub(super) fn bounds_of(points: &[Vec3]) -> Bounds {
    points.iter().fold(Bounds::EMPTY, |bounds, &point| bounds.union(Bounds { low: point, high: point }))
}

/// The order in which leaves hold the primitives.
///
/// It leaps about in the scene's columns, so what the leaves after next hold is asked for beforehand.
#[derive(Clone, Copy)]
pub(super) struct Order<'a> {
    pub(super) order: &'a [u32],
    pub(super) sources: Sources<'a>,
}

impl Order<'_> {
    /// Primitives that are asked for before they are needed; of triangles the corners, and the triangles another so many before.
    const AHEAD: usize = 24;

    /// Indices into the column of a kind of what a leaf holds.
    pub(super) fn of(&self, leaf: Leaf, kind: Kind) -> impl Iterator<Item = usize> {
        let (first, before) = (leaf.first as usize, self.sources.before(kind));
        self.order[first..first + leaf.count as usize].iter().map(move |&index| index as usize - before)
    }

    /// Likewise of those so many places later, where these are of the kind.
    fn later<'a, T>(
        &self,
        leaf: Leaf,
        kind: Kind,
        places: usize,
        column: &'a [T],
    ) -> impl Iterator<Item = &'a T> {
        let (first, before) = (leaf.first as usize + places, self.sources.before(kind));
        let later = self.order.get(first..first + leaf.count as usize).unwrap_or_default();
        later.iter().filter_map(move |&index| column.get((index as usize).wrapping_sub(before)))
    }

    pub(super) fn spheres(&self, leaf: Leaf) -> SphereBlock {
        let Sources { geometry, scale } = self.sources;
        for sphere in self.later(leaf, Kind::Sphere, Self::AHEAD, &geometry.spheres) {
            prefetch(std::ptr::from_ref(sphere).cast());
        }
        let mut block = SphereBlock::EMPTY;
        for (lane, index) in self.of(leaf, Kind::Sphere).enumerate() {
            let sphere = &geometry.spheres[index];
            block.set(lane, scale.position(sphere.center), scale.length(sphere.radius), sphere.id.0);
        }
        block
    }

    pub(super) fn triangles(&self, leaf: Leaf, extent: f32) -> TriangleBlock {
        let geometry = self.sources.geometry;
        for triangle in self.later(leaf, Kind::Triangle, 2 * Self::AHEAD, &geometry.triangles) {
            prefetch(std::ptr::from_ref(triangle).cast());
        }
        for triangle in self.later(leaf, Kind::Triangle, Self::AHEAD, &geometry.triangles) {
            for index in triangle.vertices {
                prefetch(geometry.vertices.as_ptr().wrapping_add(index as usize).cast());
            }
        }
        let mut block = TriangleBlock::EMPTY;
        for (lane, index) in self.of(leaf, Kind::Triangle).enumerate() {
            let triangle = &geometry.triangles[index];
            block.set(lane, self.sources.corners(triangle.vertices), triangle.id.0, extent);
        }
        block
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_box_of_a_sphere_holds_it_and_little_more(
            center in [-2.0_f32..2.0, -1e-3..1e-3_f32, -1e-30..1e-30_f32],
            radius in prop_oneof![1e-3_f32..2.0, 1e-9..1e-6_f32, 1e-37..1e-30_f32],
        ) {
            let Bounds { low, high } = bounds_of_sphere(Vec3::from(center), radius);
            for (axis, center) in center.into_iter().enumerate() {
                let (middle, radius) = (f64::from(center), f64::from(radius));
                let beyond = [middle - radius - f64::from(low[axis]), f64::from(high[axis]) - (middle + radius)];
                let most = 3.0 * f64::from(f32::EPSILON) * (middle.abs() + radius) + 2.0 * f64::from(f32::MIN_POSITIVE);
                for beyond in beyond {
                    prop_assert!(beyond > 0.0 && beyond <= most, "{beyond} beyond, at most {most}");
                }
            }
        }
    }
}
