//! A mesh of triangles on its way into the scene: scaled, turned and moved, and of the materials that are meant.

use super::faces::Cutter;
use crate::load::error::{InputError, Place, Warnings};
use crate::load::number::{self, rounded_3};
use crate::math::sin_cos_degrees;
use crate::scene::{Added, Geometry, Material, MaterialId};
use glam::{DMat3, DVec3};
use std::path::{Path, PathBuf};

/// A mesh as its file has it, in f64.
pub(in crate::load) struct Mesh {
    path: PathBuf,
    pub(super) positions: Vec<DVec3>,
    /// Smallest and largest coordinates of all vertices of the file, those that no face uses included.
    pub(super) bounds: Option<(DVec3, DVec3)>,
    pub(super) normals: Vec<DVec3>,
    faces: Vec<Face>,
    /// Indices into `positions`: those of the first face, then those of the second, and so on.
    corners: Vec<u32>,
    /// Indices into `normals`: likewise, of the faces that have some.
    corner_normals: Vec<u32>,
    /// The file's own.
    pub(in crate::load) materials: Vec<Material>,
}

struct Face {
    corners: u32,
    has_normals: bool,
    /// An index into the file's own materials.
    material: Option<u32>,
}

/// Scale, then rotation about x, y and z in this order, then translation.
pub(in crate::load) struct Transform {
    scale: f64,
    rotation: DMat3,
    translation: DVec3,
}

impl Transform {
    pub(super) const IDENTITY: Self =
        Self { scale: 1.0, rotation: DMat3::IDENTITY, translation: DVec3::ZERO };

    pub(in crate::load) fn new(scale: f64, rotate_degrees: DVec3, translation: DVec3) -> Self {
        let [x, y, z] = rotate_degrees.to_array().map(sin_cos_degrees);
        let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, x.1, x.0), DVec3::new(0.0, -x.0, x.1));
        let about_y = DMat3::from_cols(DVec3::new(y.1, 0.0, -y.0), DVec3::Y, DVec3::new(y.0, 0.0, y.1));
        let about_z = DMat3::from_cols(DVec3::new(z.1, z.0, 0.0), DVec3::new(-z.0, z.1, 0.0), DVec3::Z);
        Self { scale, rotation: about_z * about_y * about_x, translation }
    }

    fn position(&self, position: DVec3) -> DVec3 {
        self.rotation * (self.scale * position) + self.translation
    }

    /// A negative scale turns the surface inside out, and its normals with it.
    fn normal(&self, normal: DVec3) -> DVec3 {
        self.rotation * (self.scale.signum() * normal)
    }
}

/// What a mesh is made of.
#[derive(Clone, Copy)]
pub(in crate::load) enum MaterialChoice {
    /// All of it of this.
    Given(MaterialId),
    /// Each face of what the file says.
    Own {
        /// The scene's id of the file's first material.
        first: MaterialId,
        /// For faces of which the file says nothing.
        otherwise: Option<MaterialId>,
    },
}

impl Mesh {
    pub(super) fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            positions: Vec::new(),
            bounds: None,
            normals: Vec::new(),
            faces: Vec::new(),
            corners: Vec::new(),
            corner_normals: Vec::new(),
            materials: Vec::new(),
        }
    }

    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Adds a face; normals, where there are any, stand beside the corners. What the indices refer to may come later.
    pub(super) fn add_face(&mut self, corners: &[u32], normals: Option<&[u32]>, material: Option<u32>) {
        let count = u32::try_from(corners.len()).unwrap_or(u32::MAX);
        self.faces.push(Face { corners: count, has_normals: normals.is_some(), material });
        self.corners.extend_from_slice(corners);
        self.corner_normals.extend_from_slice(normals.unwrap_or_default());
    }

    /// Puts the mesh into the scene.
    pub(in crate::load) fn add_to(
        &self,
        geometry: &mut Geometry,
        transform: &Transform,
        choice: MaterialChoice,
        warnings: &mut Warnings,
    ) -> Result<(), InputError> {
        let first_vertex = geometry.add_vertices(self.transformed(transform)?);
        let first_vertex = first_vertex.map_err(|problem| self.error(Place::File, problem.to_string()))?;
        let normals = self.normals.iter().map(|&normal| rounded_3(transform.normal(normal)));
        let first_normal =
            geometry.add_normals(normals).map_err(|problem| self.error(Place::File, problem.to_string()))?;
        geometry.triangles.reserve_exact(self.corners.len() - 2 * self.faces.len());
        let mut cutter = Cutter::default();
        let (mut corners, mut normals) = (self.corners.as_slice(), self.corner_normals.as_slice());
        for (index, face) in self.faces.iter().enumerate() {
            let place = || Place::Element(format!("face {}", index + 1));
            let material = match (choice, face.material) {
                (MaterialChoice::Given(material), _) => material,
                (MaterialChoice::Own { first, .. }, Some(own)) => MaterialId(first.0 + own),
                (MaterialChoice::Own { otherwise, .. }, None) => otherwise.ok_or_else(|| {
                    let message =
                        "the file gives this face no material; name one for the whole mesh in the scene";
                    self.error(place(), message)
                })?,
            };
            let of_face = corners.split_off(..face.corners as usize).unwrap_or_default();
            let normals_of_face = match face.has_normals {
                true => normals.split_off(..face.corners as usize),
                false => None,
            };
            for &places in cutter.cut(of_face.iter().map(|&corner| self.positions[corner as usize])) {
                let corners = places.map(|place| first_vertex + of_face[place]);
                let normals =
                    normals_of_face.map(|normals| places.map(|place| first_normal + normals[place]));
                let added = geometry.add_triangle(corners, normals, material);
                if added.map_err(|problem| self.error(place(), problem.to_string()))? == Added::WithoutArea {
                    warnings.add("without area", &self.path, || {
                        (place(), "a triangle of this face has no area and is left out".to_owned())
                    });
                }
            }
        }
        Ok(())
    }

    fn transformed(&self, transform: &Transform) -> Result<Vec<glam::Vec3>, InputError> {
        let place = |(index, &position)| {
            let moved: DVec3 = transform.position(position);
            let check = moved.to_array().into_iter().try_for_each(|value| number::check(value).map(drop));
            check.map_err(|message| self.error(Place::Element(format!("vertex {}", index + 1)), message))?;
            Ok(rounded_3(moved))
        };
        self.positions.iter().enumerate().map(place).collect()
    }

    fn error(&self, place: Place, message: impl Into<String>) -> InputError {
        InputError::refused(&self.path, place, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transform_scales_then_rotates_about_x_y_z_then_moves() {
        let move_by = DVec3::new(10.0, 20.0, 30.0);
        for (degrees, expected) in [
            ([90., 0., 0.], [2., -6., 4.]),
            ([0., 90., 0.], [6., 4., -2.]),
            ([0., 0., 90.], [-4., 2., 6.]),
            // (2, 4, 6) → about x (2, -6, 4) → about y (4, -6, -2) → about z (6, 4, -2)
            ([90., 90., 90.], [6., 4., -2.]),
        ] {
            let transform = Transform::new(2.0, DVec3::from(degrees), move_by);
            assert_eq!(
                transform.position(DVec3::new(1., 2., 3.)),
                DVec3::from(expected) + move_by,
                "{degrees:?}"
            );
        }
    }
}
