//! Primitives as the kernels read them: blocks of one kind, a lane a primitive.

use crate::kernel::UNIT_ROUNDOFF;
use glam::Vec3;

/// Primitives of a block.
pub(crate) const BLOCK: usize = 4;

/// | bytes | field |
/// |---|---|
/// | 0–143 | `vertices`: first, second and third; x, y and z; a lane a triangle |
/// | 144–159 | `size` |
/// | 160–175 | `error_area` |
/// | 176–191 | `ids` |
///
/// Three lines of memory, which it would lie across four of if it did not begin with one.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub(crate) struct TriangleBlock {
    pub(crate) vertices: [[[f32; BLOCK]; 3]; 3],
    /// Length of the longest edge, at least [`LEAST_SIZE`]; not a number where there is no triangle, so that no ray comes near
    /// to its edges.
    pub(crate) size: [f32; BLOCK],
    /// Twice the area, and for needles more: what the error of t is in proportion to.
    pub(crate) error_area: [f32; BLOCK],
    pub(crate) ids: [u32; BLOCK],
}

/// | bytes | field |
/// |---|---|
/// | 0–47 | `centers`: x, y and z; a lane a sphere |
/// | 48–63 | `radii` |
/// | 64–79 | `ids` |
///
/// One and a quarter lines of memory: it lies across two wherever it begins at a quarter.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct SphereBlock {
    pub(crate) centers: [[f32; BLOCK]; 3],
    /// Not a number where there is no sphere.
    pub(crate) radii: [f32; BLOCK],
    pub(crate) ids: [u32; BLOCK],
}

/// A polygon's plane and where its corners are; tested one at a time, its edges in lanes.
#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct PolygonFace {
    /// Unit, outward.
    pub(crate) normal: [f32; 3],
    /// The first corner.
    pub(crate) point: [f32; 3],
    /// No two corners are farther apart.
    pub(crate) size: f32,
    /// Its length.
    pub(crate) longest_edge: f32,
    /// What is nearer to the plane than this touches it.
    pub(crate) slack: f32,
    pub(crate) id: u32,
    /// Index of the first corner in the columns of corners.
    pub(crate) first_corner: u32,
    /// As many as corners.
    pub(crate) edges: u32,
    /// In its column of the scene's geometry.
    pub(crate) source: u32,
}

/// How many of some lanes of a block hold a primitive.
#[inline(always)]
pub(crate) fn count_there(ids: &[u32]) -> usize {
    ids.iter().map(|&id| usize::from(id != u32::MAX)).sum()
}

const _: () = assert!(size_of::<TriangleBlock>() == 192 && size_of::<SphereBlock>() == 80);
const _: () = assert!(size_of::<PolygonFace>() == 52);

/// How near to a surface a point may be that the kernels cannot tell from one on it, or beyond it: some roundings of the
/// distances from the point to the primitive's ends, and where they touch that is the primitive's size. Of polygons the height
/// above the plane is off by 7u of it, of spheres by 18u of the diameter; both are rounded up.
pub(super) fn touch_distance(size: f32) -> f32 {
    TOUCHING * size
}

const TOUCHING: f32 = 32.0 * UNIT_ROUNDOFF;

/// That of a sphere of radius 1, of which the size is the diameter: a power of two, so that this times the radius's square is what
/// the kernel asks for, with no rounding of its own.
pub(crate) const TOUCHING_OF_UNIT_SPHERE: f32 = 2.0 * TOUCHING;

/// No triangle is taken to be smaller, as a share of the scene. What the kernel compares with the cube of this is the product
/// of three lengths, of which f32 would lose digits below 2⁻¹⁰²: a ray that comes so near to so small a triangle is decided in
/// f64.
const LEAST_SIZE: f32 = 1.0 / (1 << 28) as f32;

impl TriangleBlock {
    /// Triangles of no area, which nothing hits.
    pub(super) const EMPTY: Self = Self {
        vertices: [[[0.0; BLOCK]; 3]; 3],
        size: [f32::NAN; BLOCK],
        error_area: [0.0; BLOCK],
        ids: [u32::MAX; BLOCK],
    };

    /// `scene_extent` is the largest coordinate of all primitives.
    pub(super) fn set(&mut self, lane: usize, vertices: [Vec3; 3], id: u32, scene_extent: f32) {
        for (vertex, point) in vertices.into_iter().enumerate() {
            for axis in 0..3 {
                self.vertices[vertex][axis][lane] = point[axis];
            }
        }
        let [a, b, c] = vertices;
        let size = [a - b, b - c, c - a].map(Vec3::length).into_iter().fold(0.0, f32::max);
        let double_area = (b - a).cross(c - a).length();
        // The kernel's error of a distance from the plane is 6u·(L + s²/h) by measurement, with s the longest edge and h the
        // height above it; and s²/h = s³ / double area.
        let cube = size * size * size;
        self.size[lane] = size.max(LEAST_SIZE);
        self.error_area[lane] = double_area + cube / scene_extent;
        self.ids[lane] = id;
    }
}

impl SphereBlock {
    /// Spheres of no surface, which nothing hits.
    pub(super) const EMPTY: Self =
        Self { centers: [[0.0; BLOCK]; 3], radii: [f32::NAN; BLOCK], ids: [u32::MAX; BLOCK] };

    pub(super) fn set(&mut self, lane: usize, center: Vec3, radius: f32, id: u32) {
        for axis in 0..3 {
            self.centers[axis][lane] = center[axis];
        }
        self.radii[lane] = radius;
        self.ids[lane] = id;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_touches_a_sphere_follows_from_its_square() {
        for radius in [1.0_f32, 1.5, 0.1, 1.0 / 3.0, 1e-6, 1.999_999_9] {
            assert_eq!(TOUCHING_OF_UNIT_SPHERE * (radius * radius), touch_distance(2.0 * radius) * radius);
        }
    }
}
