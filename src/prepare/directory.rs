//! From a primitive's id to the primitive.

use super::PrepareError;
use super::bvh::Kind;
use crate::scene::{Geometry, MaterialId, PrimitiveId};

/// Ids one after the other that are those of neighbours in a column.
#[derive(Clone, Copy, Debug)]
struct Run {
    first_id: u32,
    kind: Kind,
    /// Index of the first in its column of [`Geometry`].
    first_index: u32,
}

/// Files tend to name primitives of one kind after the other, so that few runs say all. Where they do not, there is a word for
/// each id instead, so that none takes long to find.
pub(crate) struct Directory {
    /// In the order of ids; none where there are words.
    runs: Vec<Run>,
    /// By id: the kind in the 2 high bits, the index in its column of [`Geometry`] below; none where there are runs.
    entries: Vec<u32>,
}

impl Directory {
    /// Ids below this can be had: `traverse` finds a primitive by a word that has 28 bits for its block.
    pub(crate) const LIMIT: u32 = 1 << 28;

    /// Most runs that are looked through for each id.
    const MOST_RUNS: usize = 8;

    const INDEX: u32 = (1 << 30) - 1;

    pub(super) fn new(geometry: &Geometry) -> Result<Self, PrepareError> {
        let Geometry { spheres, triangles, polygons, .. } = geometry;
        let last = [
            spheres.last().map(|sphere| sphere.id),
            triangles.last().map(|triangle| triangle.id),
            polygons.last().map(|polygon| polygon.id),
        ];
        let count = last.into_iter().flatten().map(|id| u64::from(id.0) + 1).max().unwrap_or(0);
        if count > u64::from(Self::LIMIT) {
            return Err(PrepareError::TooMany { count });
        }
        let runs = runs(Kind::Sphere, spheres, |sphere| sphere.id)
            .chain(runs(Kind::Triangle, triangles, |triangle| triangle.id))
            .chain(runs(Kind::Polygon, polygons, |polygon| polygon.id));
        let mut runs: Vec<Run> = runs.take(Self::MOST_RUNS + 1).collect();
        if runs.len() <= Self::MOST_RUNS {
            runs.sort_unstable_by_key(|run| run.first_id);
            return Ok(Self { runs, entries: Vec::new() });
        }
        let mut entries = vec![0; usize::try_from(count).unwrap_or(0)];
        for (index, sphere) in (0_u32..).zip(spheres) {
            entries[sphere.id.0 as usize] = index;
        }
        for (index, triangle) in (0_u32..).zip(triangles) {
            entries[triangle.id.0 as usize] = (1 << 30) | index;
        }
        for (index, polygon) in (0_u32..).zip(polygons) {
            entries[polygon.id.0 as usize] = (2 << 30) | index;
        }
        Ok(Self { runs: Vec::new(), entries })
    }

    /// What a primitive is, and its index among those of its kind.
    #[inline]
    pub(crate) fn find(&self, id: u32) -> (Kind, usize) {
        if let Some(run) = self.runs.iter().rev().find(|run| run.first_id <= id) {
            return (run.kind, (run.first_index + (id - run.first_id)) as usize);
        }
        let entry = self.entries[id as usize];
        let kind = match entry >> 30 {
            0 => Kind::Sphere,
            1 => Kind::Triangle,
            _ => Kind::Polygon,
        };
        (kind, (entry & Self::INDEX) as usize)
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.runs.as_slice()) + size_of_val(self.entries.as_slice())
    }
}

/// The runs of a column, which is in the order of ids, one of them searched for after the other: a place is in a run if its id
/// lies no farther behind the run's first than it does itself.
fn runs<T>(kind: Kind, column: &[T], id: impl Fn(&T) -> PrimitiveId) -> impl Iterator<Item = Run> {
    let mut first = 0;
    std::iter::from_fn(move || {
        let first_id = id(column.get(first)?).0;
        let run = Run { first_id, kind, first_index: u32::try_from(first).unwrap_or(u32::MAX) };
        let (mut end, mut beyond) = (first + 1, column.len());
        while end < beyond {
            let middle = usize::midpoint(end, beyond);
            if (id(&column[middle]).0 - first_id) as usize == middle - first {
                end = middle + 1;
            } else {
                beyond = middle;
            }
        }
        first = end;
        Some(run)
    })
}

/// The material of a primitive.
pub(crate) fn material_of(geometry: &Geometry, (kind, index): (Kind, usize)) -> MaterialId {
    match kind {
        Kind::Sphere => geometry.spheres[index].material,
        Kind::Triangle => geometry.triangles[index].material,
        Kind::Polygon => geometry.polygons[index].material,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Spheres, and triangles among them wherever a number is found.
    fn geometry(count: u32, triangles: &[u32]) -> Geometry {
        let mut geometry = Geometry::default();
        let first = geometry.add_vertices([Vec3::ZERO, Vec3::X, Vec3::Y]).unwrap();
        for id in 0..count {
            if triangles.contains(&id) {
                geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(id)).unwrap();
            } else {
                geometry.add_sphere(Vec3::ZERO, 1.0, MaterialId(id)).unwrap();
            }
        }
        geometry
    }

    #[test]
    fn every_id_leads_to_its_primitive_in_runs_and_in_words() {
        let cases: [(&str, Vec<u32>, bool); 5] = [
            ("spheres alone", vec![], true),
            ("triangles alone", (0..40).collect(), true),
            ("spheres between triangles", vec![0, 1, 2, 7, 8, 39], true),
            ("eight runs", vec![0, 10, 20, 30], true),
            ("nine runs", vec![1, 10, 20, 30], false),
        ];
        for (name, triangles, has_runs) in cases {
            let geometry = geometry(40, &triangles);
            let directory = Directory::new(&geometry).unwrap();
            assert_eq!(directory.entries.is_empty(), has_runs, "{name}");
            for id in 0..40 {
                let (kind, index) = directory.find(id);
                let is_triangle = triangles.contains(&id);
                assert_eq!(kind, if is_triangle { Kind::Triangle } else { Kind::Sphere }, "{name}, {id}");
                assert_eq!(material_of(&geometry, (kind, index)), MaterialId(id), "{name}, {id}");
            }
        }
    }
}
