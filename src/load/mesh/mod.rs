//! Mesh files, alone or as a part of a scene.
//!
//! - `obj` with `mtl`, and `ply`: a file a format; `lines`: the logical lines of the first two
//! - `faces`: how a face is cut into triangles; `triangles`: the mesh that comes of it, on its way into the scene

mod faces;
mod lines;
mod mtl;
mod obj;
mod ply;
mod triangles;

pub(super) use triangles::{MaterialChoice, Mesh, Transform};

use super::error::{InputError, Warnings};
use super::extension;
use super::framing::framed_scene;
use crate::scene::{Geometry, Material, MaterialId, Scene};
use std::path::Path;

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
    framed_scene(path, mesh.bounds, geometry, materials)
}
