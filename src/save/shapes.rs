//! The primitives of a scene in the order of their numbers.

use crate::scene::{Geometry, MaterialId, Polygon, Sphere, Triangle};
use glam::Vec3;

/// What has a number.
#[derive(Clone, Copy)]
pub(super) enum Shape<'a> {
    Sphere(&'a Sphere),
    Triangle(&'a Triangle),
    Polygon(&'a Polygon),
    /// A triangle or polygon without area, of which nothing but the number was kept.
    LeftOut,
}

impl Shape<'_> {
    /// What it is made of; anything will do for what was left out.
    pub(super) fn material(self) -> Option<MaterialId> {
        match self {
            Self::Sphere(sphere) => Some(sphere.material),
            Self::Triangle(triangle) => Some(triangle.material),
            Self::Polygon(polygon) => Some(polygon.material),
            Self::LeftOut => None,
        }
    }

    pub(super) fn has_vertex_normals(self) -> bool {
        match self {
            Self::Triangle(triangle) => triangle.normals.is_some(),
            Self::Polygon(polygon) => polygon.normals.is_some(),
            Self::Sphere(_) | Self::LeftOut => false,
        }
    }
}

/// Every number from 0, with what has it. A scene without materials has no primitives either.
pub(super) fn in_order(geometry: &Geometry) -> impl Iterator<Item = Shape<'_>> {
    let mut spheres = geometry.spheres.iter().peekable();
    let mut triangles = geometry.triangles.iter().peekable();
    let mut polygons = geometry.polygons.iter().peekable();
    (0..geometry.numbered_count()).map(move |id| {
        if let Some(sphere) = spheres.next_if(|sphere| sphere.id.0 == id) {
            Shape::Sphere(sphere)
        } else if let Some(triangle) = triangles.next_if(|triangle| triangle.id.0 == id) {
            Shape::Triangle(triangle)
        } else if let Some(polygon) = polygons.next_if(|polygon| polygon.id.0 == id) {
            Shape::Polygon(polygon)
        } else {
            Shape::LeftOut
        }
    })
}

/// World positions of the corners of a triangle, or their normals, out of the column that they are in.
pub(super) fn listed(column: &[Vec3], places: [u32; 3]) -> [Vec3; 3] {
    places.map(|place| column[place as usize])
}

/// The same of a polygon.
pub(super) fn run(column: &[Vec3], places: std::ops::Range<u32>) -> &[Vec3] {
    &column[places.start as usize..places.end as usize]
}
