//! From a primitive's id to the primitive.

use super::PrepareError;
use super::bvh::Kind;
use crate::scene::{Geometry, MaterialId};

/// A word for each id: the kind in the 2 high bits, the index in its column of [`Geometry`] below.
pub(crate) struct Directory {
    entries: Vec<u32>,
}

impl Directory {
    /// Ids below this can be had: `traverse` finds a primitive by a word that has 28 bits for its block.
    pub(crate) const LIMIT: u32 = 1 << 28;

    const INDEX: u32 = (1 << 30) - 1;

    pub(super) fn new(geometry: &Geometry) -> Result<Self, PrepareError> {
        // Columns are in the order of ids.
        let last = [
            geometry.spheres.last().map(|sphere| sphere.id),
            geometry.triangles.last().map(|triangle| triangle.id),
            geometry.polygons.last().map(|polygon| polygon.id),
        ];
        let count = last.into_iter().flatten().map(|id| u64::from(id.0) + 1).max().unwrap_or(0);
        if count > u64::from(Self::LIMIT) {
            return Err(PrepareError::TooMany { count });
        }
        let mut entries = vec![0; usize::try_from(count).unwrap_or(0)];
        for (index, sphere) in (0_u32..).zip(&geometry.spheres) {
            entries[sphere.id.0 as usize] = index;
        }
        for (index, triangle) in (0_u32..).zip(&geometry.triangles) {
            entries[triangle.id.0 as usize] = (1 << 30) | index;
        }
        for (index, polygon) in (0_u32..).zip(&geometry.polygons) {
            entries[polygon.id.0 as usize] = (2 << 30) | index;
        }
        Ok(Self { entries })
    }

    /// What a primitive is, and its index among those of its kind.
    pub(crate) fn find(&self, id: u32) -> (Kind, usize) {
        let entry = self.entries[id as usize];
        let kind = match entry >> 30 {
            0 => Kind::Sphere,
            1 => Kind::Triangle,
            _ => Kind::Polygon,
        };
        (kind, (entry & Self::INDEX) as usize)
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.entries.as_slice())
    }
}

/// The material of a primitive.
pub(crate) fn material_of(geometry: &Geometry, (kind, index): (Kind, usize)) -> MaterialId {
    match kind {
        Kind::Sphere => geometry.spheres[index].material,
        Kind::Triangle => geometry.triangles[index].material,
        Kind::Polygon => geometry.polygons[index].material,
    }
}
