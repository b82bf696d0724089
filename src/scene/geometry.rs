//! The flat list of primitives, a column a kind, and what makes a primitive acceptable.

use super::MaterialId;
use glam::{DVec3, Vec3};
use serde::Serialize;
use std::ops::Range;
use thiserror::Error;

/// Place in the scene's flat list; equal hits go to the smaller. `u32::MAX` is never one: it means a miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct PrimitiveId(pub u32);

/// All primitives of a scene. Triangles and polygons refer to shared columns of vertices and of normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Geometry {
    /// World positions.
    pub vertices: Vec<Vec3>,
    /// World directions as the file gives them, not necessarily unit.
    pub normals: Vec<Vec3>,
    /// In order of id.
    pub spheres: Vec<Sphere>,
    /// In order of id.
    pub triangles: Vec<Triangle>,
    /// In order of id.
    pub polygons: Vec<Polygon>,
    next_id: u32,
}

/// A sphere; its outside is away from the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Place in the flat list.
    pub id: PrimitiveId,
    /// World position.
    pub center: Vec3,
    /// World length, greater than 0.
    pub radius: f32,
    /// What it is made of.
    pub material: MaterialId,
}

/// A triangle of non-zero area; its outside follows from the order of its vertices by the right-hand rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Place in the flat list.
    pub id: PrimitiveId,
    /// Indices into [`Geometry::vertices`].
    pub vertices: [u32; 3],
    /// Indices into [`Geometry::normals`], where the file gives a normal for each vertex.
    pub normals: Option<[u32; 3]>,
    /// What it is made of.
    pub material: MaterialId,
}

/// A planar polygon, convex or concave; its outside is unit Σ p_k × p_k+1.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Place in the flat list.
    pub id: PrimitiveId,
    /// A run of [`Geometry::vertices`], three or more.
    pub vertices: Range<u32>,
    /// A run of [`Geometry::normals`], as many, where the file gives a normal for each vertex.
    pub normals: Option<Range<u32>>,
    /// What it is made of.
    pub material: MaterialId,
}

/// What became of an acceptable triangle or polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Added {
    /// It is in the scene.
    Flat,
    /// It is in the scene, though its vertices lie farther off its plane than rounding to f32 explains.
    Bent {
        /// Largest distance of a vertex from the plane, divided by the diagonal of the bounding box.
        off_plane: f64,
    },
    /// It has no area, so nothing can hit it: it keeps its number and is left out.
    WithoutArea,
}

/// Why a primitive cannot be accepted.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum GeometryProblem {
    /// A sphere without a surface.
    #[error("the radius is {0}; it must be greater than 0")]
    Radius(f32),
    /// A line or a point.
    #[error("a polygon needs at least 3 vertices; this one has {0}")]
    TooFewVertices(usize),
    /// Not a polygon in the sense of the model.
    #[error(
        "the polygon is not planar: a vertex lies {off_plane:.3e} of the polygon's extent off its plane (at most 1e-3 \
         is accepted); split it into triangles"
    )]
    NotPlanar {
        /// Largest distance of a vertex from the plane, divided by the diagonal of the bounding box.
        off_plane: f64,
    },
    /// Ids are 32 bits wide and the largest one means a miss.
    #[error("a scene has room for 2^32 - 1 primitives and as many vertices, and this one has more")]
    TooMany,
}

impl Geometry {
    /// Farther off the plane than this, as a share of the extent, is no polygon.
    pub const REFUSED_OFF_PLANE: f64 = 1e-3;
    /// Farther off the plane than this, as a share of the extent, is more than rounding to f32 explains.
    pub const WARNED_OFF_PLANE: f64 = 8.0 / (1 << 24) as f64;

    /// How many primitives can be hit; those that were left out keep their ids but do not count.
    #[must_use]
    pub fn primitive_count(&self) -> usize {
        self.spheres.len() + self.triangles.len() + self.polygons.len()
    }

    /// How many primitives have got a number; those that were left out have one too.
    #[must_use]
    pub fn numbered_count(&self) -> u32 {
        self.next_id
    }

    /// Id and material of every primitive that can be hit: spheres, then triangles, then polygons.
    pub fn materials(&self) -> impl Iterator<Item = (PrimitiveId, MaterialId)> {
        let spheres = self.spheres.iter().map(|sphere| (sphere.id, sphere.material));
        let triangles = self.triangles.iter().map(|triangle| (triangle.id, triangle.material));
        let polygons = self.polygons.iter().map(|polygon| (polygon.id, polygon.material));
        spheres.chain(triangles).chain(polygons)
    }

    /// Adds a sphere.
    ///
    /// # Errors
    /// A radius that is not greater than 0 once it is an f32.
    pub fn add_sphere(
        &mut self,
        center: Vec3,
        radius: f32,
        material: MaterialId,
    ) -> Result<(), GeometryProblem> {
        if radius.is_nan() || radius <= 0.0 {
            return Err(GeometryProblem::Radius(radius));
        }
        let id = self.take_id()?;
        self.spheres.push(Sphere { id, center, radius, material });
        Ok(())
    }

    /// Appends vertices for triangles to refer to, and returns the index of the first.
    ///
    /// # Errors
    /// More than 32 bits can count.
    pub fn add_vertices(&mut self, vertices: impl IntoIterator<Item = Vec3>) -> Result<u32, GeometryProblem> {
        append(&mut self.vertices, vertices)
    }

    /// Appends normals for triangles to refer to, and returns the index of the first.
    ///
    /// # Errors
    /// More than 32 bits can count.
    pub fn add_normals(&mut self, normals: impl IntoIterator<Item = Vec3>) -> Result<u32, GeometryProblem> {
        append(&mut self.normals, normals)
    }

    /// Adds a triangle between vertices that have been added before.
    ///
    /// # Errors
    /// More primitives than ids.
    pub fn add_triangle(
        &mut self,
        vertices: [u32; 3],
        normals: Option<[u32; 3]>,
        material: MaterialId,
    ) -> Result<Added, GeometryProblem> {
        let id = self.take_id()?;
        let [a, b, c] = vertices.map(|index| self.vertices[index as usize].as_dvec3());
        if (b - a).cross(c - a) == DVec3::ZERO {
            return Ok(Added::WithoutArea);
        }
        self.triangles.push(Triangle { id, vertices, normals, material });
        Ok(Added::Flat)
    }

    /// Adds a polygon.
    ///
    /// # Errors
    /// Fewer than three vertices, or vertices farther than [`Self::REFUSED_OFF_PLANE`] off the plane.
    pub fn add_polygon(
        &mut self,
        vertices: &[Vec3],
        normals: Option<&[Vec3]>,
        material: MaterialId,
    ) -> Result<Added, GeometryProblem> {
        if vertices.len() < 3 {
            return Err(GeometryProblem::TooFewVertices(vertices.len()));
        }
        let id = self.take_id()?;
        let Some(off_plane) = off_plane(vertices) else { return Ok(Added::WithoutArea) };
        if off_plane > Self::REFUSED_OFF_PLANE {
            return Err(GeometryProblem::NotPlanar { off_plane });
        }
        let first = self.add_vertices(vertices.iter().copied())?;
        let vertices = first..first + count(vertices.len())?;
        let normals = match normals {
            None => None,
            Some(normals) => {
                let first = self.add_normals(normals.iter().copied())?;
                Some(first..first + count(normals.len())?)
            }
        };
        self.polygons.push(Polygon { id, vertices, normals, material });
        Ok(if off_plane > Self::WARNED_OFF_PLANE { Added::Bent { off_plane } } else { Added::Flat })
    }

    /// Smallest and largest coordinates of everything, or `None` where there is nothing.
    #[must_use]
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let spheres = self.spheres.iter().flat_map(|sphere| {
            let (center, radius) = (sphere.center.as_dvec3(), DVec3::splat(f64::from(sphere.radius)));
            [center - radius, center + radius]
        });
        let vertices = self.vertices.iter().map(|vertex| vertex.as_dvec3());
        spheres.chain(vertices).fold(None, widened)
    }

    fn take_id(&mut self) -> Result<PrimitiveId, GeometryProblem> {
        let id = self.next_id;
        if id == u32::MAX {
            return Err(GeometryProblem::TooMany);
        }
        self.next_id += 1;
        Ok(PrimitiveId(id))
    }
}

/// Bounds that also hold a point.
pub(crate) fn widened(bounds: Option<(DVec3, DVec3)>, point: DVec3) -> Option<(DVec3, DVec3)> {
    let (low, high) = bounds.unwrap_or((point, point));
    Some((low.min(point), high.max(point)))
}

fn append(column: &mut Vec<Vec3>, more: impl IntoIterator<Item = Vec3>) -> Result<u32, GeometryProblem> {
    let first = count(column.len())?;
    column.extend(more);
    count(column.len())?;
    Ok(first)
}

fn count(length: usize) -> Result<u32, GeometryProblem> {
    u32::try_from(length).map_err(|_| GeometryProblem::TooMany)
}

/// Newell's normal of a closed loop of points, unit Σ p_k × p_k+1, or `None` where the sum is zero.
///
/// Source: Newell's method as given by Sutherland, Sproull and Schumacker, "A Characterization of Ten Hidden-Surface
/// Algorithms", 1974. Points are taken relative to the first, which leaves the sum as it is and keeps its digits.
#[must_use]
pub(crate) fn polygon_normal(points: &[DVec3]) -> Option<DVec3> {
    let first = *points.first()?;
    let sum: DVec3 = points
        .windows(2)
        .map(|edge| (edge[0] - first).cross(edge[1] - first))
        .fold(DVec3::ZERO, |a, b| a + b);
    // The edge from the last point back to the first adds (p_m - p_1) × 0 = 0.
    sum.try_normalize()
}

/// Largest distance of a vertex from the polygon's plane as a share of its bounding box's diagonal; `None` without area.
fn off_plane(vertices: &[Vec3]) -> Option<f64> {
    let points: Vec<DVec3> = vertices.iter().map(|vertex| vertex.as_dvec3()).collect();
    let normal = polygon_normal(&points)?;
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let farthest = points.iter().map(|&point| (point - points[0]).dot(normal).abs()).fold(0.0, f64::max);
    Some(farthest / (high - low).length())
}
