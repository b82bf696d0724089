//! Primitives as the kernels read them: blocks of one kind, a lane a primitive.

use crate::kernel::UNIT_ROUNDOFF;
use glam::Vec3;

/// Primitives of a block.
pub(crate) const BLOCK: usize = 4;

/// | bytes | field |
/// |---|---|
/// | 0–143 | `vertices`: first, second and third; x, y and z; a lane a triangle |
/// | 144–159 | `slack` |
/// | 160–175 | `error_area` |
/// | 176–191 | `ids` |
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct TriangleBlock {
    pub(crate) vertices: [[[f32; BLOCK]; 3]; 3],
    /// What is nearer to the plane than this touches it, times twice the area; see [`touch_distance`].
    pub(crate) slack: [f32; BLOCK],
    /// Twice the area, and for needles more: what the error of t is in proportion to.
    pub(crate) error_area: [f32; BLOCK],
    pub(crate) ids: [u32; BLOCK],
}

/// | bytes | field |
/// |---|---|
/// | 0–47 | `centers`: x, y and z; a lane a sphere |
/// | 48–63 | `radii` |
/// | 64–79 | `slack` |
/// | 80–95 | `ids` |
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct SphereBlock {
    pub(crate) centers: [[f32; BLOCK]; 3],
    /// Not a number where there is no sphere.
    pub(crate) radii: [f32; BLOCK],
    /// What is nearer to the surface than this touches it, times the radius.
    pub(crate) slack: [f32; BLOCK],
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

const _: () = assert!(size_of::<TriangleBlock>() == 192 && size_of::<SphereBlock>() == 96);
const _: () = assert!(size_of::<PolygonFace>() == 44);

/// How near a point that was rounded to f32 is to a surface that it lies on, as the kernels see it: the point itself is off
/// by √3·u of its coordinates, and the test's own rounding is 6u of the distances from the point to the primitive's ends,
/// which is its size where they touch. Nothing nearer than this can be told apart from touching.
pub(super) fn touch_distance(extent: f32, size: f32) -> f32 {
    UNIT_ROUNDOFF * (2.0 * extent + 6.0 * size)
}

impl TriangleBlock {
    /// Triangles of no area, which nothing hits.
    pub(super) const EMPTY: Self = Self {
        vertices: [[[0.0; BLOCK]; 3]; 3],
        slack: [0.0; BLOCK],
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
        let extent = vertices.map(|vertex| vertex.abs().max_element()).into_iter().fold(0.0, f32::max);
        let size = [a - b, b - c, c - a].map(Vec3::length).into_iter().fold(0.0, f32::max);
        let double_area = (b - a).cross(c - a).length();
        // The kernel's error of a distance from the plane is 6u·(L + s²/h) by measurement, with s the longest edge and h the
        // height above it; and s²/h = s³ / double area.
        let cube = size * size * size;
        self.slack[lane] = touch_distance(extent, size) * double_area + 6.0 * UNIT_ROUNDOFF * cube;
        self.error_area[lane] = double_area + cube / scene_extent;
        self.ids[lane] = id;
    }
}

impl SphereBlock {
    /// Spheres of no surface, which nothing hits.
    pub(super) const EMPTY: Self = Self {
        centers: [[0.0; BLOCK]; 3],
        radii: [f32::NAN; BLOCK],
        slack: [0.0; BLOCK],
        ids: [u32::MAX; BLOCK],
    };

    pub(super) fn set(&mut self, lane: usize, center: Vec3, radius: f32, id: u32) {
        for axis in 0..3 {
            self.centers[axis][lane] = center[axis];
        }
        self.radii[lane] = radius;
        let extent = center.abs().max_element() + radius;
        self.slack[lane] = touch_distance(extent, 2.0 * radius) * radius;
        self.ids[lane] = id;
    }
}
