//! Wavefront OBJ, read by `tobj` after a first pass has checked it.

use super::Mesh;
use super::obj_check::{Checked, check};
use crate::load::error::{InputError, Place, Warnings};
use crate::load::text::Text;
use glam::DVec3;
use std::path::Path;

pub(super) fn read(path: &Path, wants_materials: bool, warnings: &mut Warnings) -> Result<Mesh, InputError> {
    let text = Text::read_lossy(path)?;
    let checked = check(&text, wants_materials, warnings)?;
    if checked.faces_have_normals.is_empty() {
        let message = "the file has no faces (`f`), so there is nothing to see";
        return Err(InputError::refused(path, Place::File, message));
    }
    parse(path, checked)
}

fn parse(path: &Path, checked: Checked) -> Result<Mesh, InputError> {
    let refused = |why: &dyn std::fmt::Display| {
        InputError::refused(path, Place::File, format!("this is not an OBJ file that can be read: {why}"))
    };
    let options =
        tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..tobj::LoadOptions::default() };
    let (for_library, materials) = checked.library.into_parts();
    // The library asks for materials where it meets a `mtllib`; they are all known here, before the first line.
    let lines = format!("mtllib all\n{}", checked.lines);
    let (models, _) = tobj::load_obj_buf(&mut lines.as_bytes(), &options, |_| Ok(for_library.clone()))
        .map_err(|error| refused(&error))?;

    let mut mesh = Mesh::new(path);
    (mesh.materials, mesh.bounds) = (materials, checked.bounds);
    let mut faces_have_normals = checked.faces_have_normals.into_iter();
    for model in models {
        let part = model.mesh;
        let (first_position, first_normal) = (mesh.positions.len(), mesh.normals.len());
        let vectors = |flat: &[f64]| -> Vec<DVec3> { flat.chunks_exact(3).map(DVec3::from_slice).collect() };
        mesh.positions.extend(vectors(&part.positions));
        mesh.normals.extend(vectors(&part.normals));
        let material = part.material_id.and_then(|index| u32::try_from(index).ok());
        let offset_by = |indices: &[u32], first: usize| -> Option<Vec<u32>> {
            let first = u32::try_from(first).ok()?;
            indices.iter().map(|index| index.checked_add(first)).collect()
        };
        let mut start = 0;
        let triangles = vec![3; if part.face_arities.is_empty() { part.indices.len() / 3 } else { 0 }];
        for &size in part.face_arities.iter().chain(&triangles) {
            let run = start..start + size as usize;
            start = run.end;
            let too_many = || refused(&"it has more vertices than 32 bits count");
            let corners = offset_by(&part.indices[run.clone()], first_position).ok_or_else(too_many)?;
            // Where the file gives a face no normals, those that the library makes up are left aside.
            let has_normals = faces_have_normals.next().unwrap_or(false);
            let normals = match has_normals {
                true => Some(offset_by(&part.normal_indices[run], first_normal).ok_or_else(too_many)?),
                false => None,
            };
            mesh.add_face(&corners, normals.as_deref(), material);
        }
    }
    Ok(mesh)
}
