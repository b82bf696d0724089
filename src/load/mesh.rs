//! Meshes of triangles on their way into the scene: faces are cut into triangles, vertices scaled, turned and moved.

use super::error::{InputError, Place, Warnings};
use super::framing::framed;
use super::number::{self, rounded_3};
use super::{extension, obj, ply};
use crate::math::sin_cos_degrees;
use crate::scene::{
    Added, Geometry, ImageSettings, Material, MaterialId, RenderSettings, Rgb, Scene, polygon_normal,
};
use earcut::Earcut;
use glam::{DMat3, DVec3};
use std::path::{Path, PathBuf};

/// A mesh as its file has it, in f64.
pub(super) struct Mesh {
    path: PathBuf,
    pub(super) positions: Vec<DVec3>,
    /// Smallest and largest coordinates of all vertices of the file, those that no face uses included.
    pub(super) bounds: Option<(DVec3, DVec3)>,
    pub(super) normals: Vec<DVec3>,
    triangles: Vec<MeshTriangle>,
    /// The file's own.
    pub(super) materials: Vec<Material>,
    faces: u64,
    earcut: Earcut<f64>,
}

struct MeshTriangle {
    corners: [u32; 3],
    normals: Option<[u32; 3]>,
    /// An index into the file's own materials.
    material: Option<u32>,
    /// The face it is cut from, counted from 1.
    face: u64,
}

/// Scale, then rotation about x, y and z in this order, then translation.
pub(super) struct Transform {
    scale: f64,
    rotation: DMat3,
    translation: DVec3,
}

impl Transform {
    const IDENTITY: Self = Self { scale: 1.0, rotation: DMat3::IDENTITY, translation: DVec3::ZERO };

    pub(super) fn new(scale: f64, rotate_degrees: DVec3, translation: DVec3) -> Self {
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

/// The formats of mesh files.
#[derive(Clone, Copy)]
pub(super) enum MeshFormat {
    Obj,
    Ply,
}

impl MeshFormat {
    /// The format that a name's ending asks for.
    pub(super) fn of(path: &Path) -> Option<Self> {
        match extension(path).as_deref() {
            Some("obj") => Some(Self::Obj),
            Some("ply") => Some(Self::Ply),
            _ => None,
        }
    }

    /// Reads a file; `wants_materials` says whether its own materials will be used, and so have to be found.
    pub(super) fn read(
        self,
        path: &Path,
        wants_materials: bool,
        warnings: &mut Warnings,
    ) -> Result<Mesh, InputError> {
        match self {
            Self::Obj => obj::read(path, wants_materials, warnings),
            Self::Ply => ply::read(path),
        }
    }
}

/// A scene of one mesh, with a camera and a light that show all of it, in grey where it brings no material.
pub(super) fn load_alone(
    path: &Path,
    format: MeshFormat,
    warnings: &mut Warnings,
) -> Result<Scene, InputError> {
    let mut mesh = format.read(path, true, warnings)?;
    let mut materials = vec![Material::grey()];
    let grey = MaterialId(0);
    materials.append(&mut mesh.materials);
    let choice = MaterialChoice::Own { first: MaterialId(1), otherwise: Some(grey) };
    let mut geometry = Geometry::default();
    mesh.add_to(&mut geometry, &Transform::IDENTITY, choice, warnings)?;
    let framing = framed(mesh.bounds);
    Ok(Scene {
        image: ImageSettings::default(),
        render: RenderSettings::default(),
        camera: framing.camera,
        ambient: Rgb::ZERO,
        lights: vec![framing.light],
        materials,
        geometry,
    })
}

/// What a mesh is made of.
#[derive(Clone, Copy)]
pub(super) enum MaterialChoice {
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
            triangles: Vec::new(),
            materials: Vec::new(),
            faces: 0,
            earcut: Earcut::new(),
        }
    }

    /// Widens the bounds.
    pub(super) fn extend_bounds(&mut self, position: DVec3) {
        let (low, high) = self.bounds.unwrap_or((position, position));
        self.bounds = Some((low.min(position), high.max(position)));
    }

    /// Adds the triangles of a face; normals, where there are any, stand beside the corners. Indices must be in range.
    pub(super) fn add_face(&mut self, corners: &[u32], normals: Option<&[u32]>, material: Option<u32>) {
        self.faces += 1;
        let points: Vec<DVec3> = corners.iter().map(|&corner| self.positions[corner as usize]).collect();
        let face = self.faces;
        let cut = if is_convex(&points) { fan(points.len()) } else { ears(&mut self.earcut, &points) };
        self.triangles.extend(cut.into_iter().map(|places| MeshTriangle {
            corners: places.map(|place| corners[place]),
            normals: normals.map(|normals| places.map(|place| normals[place])),
            material,
            face,
        }));
    }

    /// Puts the mesh into the scene.
    pub(super) fn add_to(
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
        for triangle in &self.triangles {
            let place = || Place::Element(format!("face {}", triangle.face));
            let material = match (choice, triangle.material) {
                (MaterialChoice::Given(material), _) => material,
                (MaterialChoice::Own { first, .. }, Some(own)) => MaterialId(first.0 + own),
                (MaterialChoice::Own { otherwise, .. }, None) => otherwise.ok_or_else(|| {
                    let message =
                        "the file gives this face no material; name one for the whole mesh in the scene";
                    self.error(place(), message)
                })?,
            };
            let corners = triangle.corners.map(|corner| first_vertex + corner);
            let normals = triangle.normals.map(|normals| normals.map(|normal| first_normal + normal));
            let added = geometry.add_triangle(corners, normals, material);
            if added.map_err(|problem| self.error(place(), problem.to_string()))? == Added::WithoutArea {
                warnings.add("without area", &self.path, place(), || {
                    "a triangle of this face has no area and is left out".to_owned()
                });
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

/// Whether every corner turns the same way about the face's normal, so that a fan covers it.
fn is_convex(points: &[DVec3]) -> bool {
    let Some(normal) = polygon_normal(points) else { return true };
    let count = points.len();
    count == 3
        || (0..count).all(|k| {
            let [before, here, after] = [points[(k + count - 1) % count], points[k], points[(k + 1) % count]];
            (here - before).cross(after - here).dot(normal) >= 0.0
        })
}

/// (0, k, k+1), the order that other tracers count in.
fn fan(count: usize) -> Vec<[usize; 3]> {
    (1..count - 1).map(|k| [0, k, k + 1]).collect()
}

/// A concave face by cutting off ears, seen along the axis in which its normal is largest; a fan where that finds none.
fn ears(earcut: &mut Earcut<f64>, points: &[DVec3]) -> Vec<[usize; 3]> {
    let normal = polygon_normal(points).unwrap_or(DVec3::Z);
    let dropped = normal.abs().max_position();
    let (mut x, mut y) = ((dropped + 1) % 3, (dropped + 2) % 3);
    if normal[dropped] < 0.0 {
        (x, y) = (y, x);
    }
    let mut places: Vec<usize> = Vec::new();
    earcut.earcut(points.iter().map(|point| [point[x], point[y]]), &[], &mut places);
    if places.is_empty() {
        return fan(points.len());
    }
    places
        .chunks_exact(3)
        .map(|corners| upright([corners[0], corners[1], corners[2]], points, normal))
        .collect()
}

/// A triangle in the face's own sense of rotation.
fn upright([a, b, c]: [usize; 3], points: &[DVec3], normal: DVec3) -> [usize; 3] {
    let turns_over = (points[b] - points[a]).cross(points[c] - points[a]).dot(normal) < 0.0;
    if turns_over { [a, c, b] } else { [a, b, c] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh_of(points: &[[f64; 3]]) -> Mesh {
        let mut mesh = Mesh::new(Path::new("test.obj"));
        mesh.positions = points.iter().copied().map(DVec3::from).collect();
        let corners: Vec<u32> = (0..).take(points.len()).collect();
        mesh.add_face(&corners, None, None);
        mesh
    }

    /// Sum of the triangles' areas, signed by the direction +z.
    fn area(mesh: &Mesh) -> f64 {
        let signed = |triangle: &MeshTriangle| {
            let [a, b, c] = triangle.corners.map(|corner| mesh.positions[corner as usize]);
            (b - a).cross(c - a).z / 2.0
        };
        mesh.triangles.iter().map(signed).sum()
    }

    #[test]
    fn a_convex_face_is_cut_into_a_fan() {
        let mesh = mesh_of(&[[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [1., 2., 0.], [0., 1., 0.]]);
        let corners: Vec<_> = mesh.triangles.iter().map(|triangle| triangle.corners).collect();
        assert_eq!(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn a_concave_face_keeps_its_notch_and_its_sense_of_rotation() {
        // An L of area 3, whose fan from the first corner would cover the notch; both senses, all three axes.
        let outline = [[2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.], [0., 0.]];
        for reversed in [false, true] {
            for axis in 0..3 {
                let mut points: Vec<[f64; 3]> = outline
                    .iter()
                    .map(|&[x, y]| {
                        let mut point = [0.5; 3];
                        (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (x, y);
                        point
                    })
                    .collect();
                if reversed {
                    points.reverse();
                }
                let mut mesh = mesh_of(&points);
                assert_eq!(mesh.triangles.len(), 4);
                for position in &mut mesh.positions {
                    let turned = [position[(axis + 1) % 3], position[(axis + 2) % 3], position[axis]];
                    *position = DVec3::from(turned);
                }
                assert_eq!(area(&mesh), if reversed { -3.0 } else { 3.0 }, "axis {axis}");
                let all_upright = mesh.triangles.iter().all(|triangle| {
                    let [a, b, c] = triangle.corners.map(|corner| mesh.positions[corner as usize]);
                    ((b - a).cross(c - a).z < 0.0) == reversed
                });
                assert!(all_upright);
            }
        }
    }

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
