//! A folder of NPY arrays: geometry alone, as other programs hand it over.
//!
//! - `vertices.npy` (N, 3) f32, and `triangles.npy` (M, 3) u32, three rows of the vertices each
//! - `spheres.npy` (K, 4) f32, centre and radius
//!
//! Ids count triangles, then spheres. Rows are counted from 0, as in NumPy and in the ids. A radius that is not greater
//! than 0 is refused, as in TOML: that a negative one means its magnitude is a custom of NFF, and in an array of numbers
//! a mistake is likelier.

use super::error::{InputError, Place, Warnings};
use super::framing::framed_scene;
use super::number::{self, rounded_3};
use super::text::read_bytes;
use crate::npy;
use crate::scene::{Added, Geometry, Material, MaterialId, Scene};
use glam::Vec3;
use std::path::Path;

/// What all of it is made of.
const GREY: MaterialId = MaterialId(0);

pub(super) fn load(folder: &Path, warnings: &mut Warnings) -> Result<Scene, InputError> {
    let geometry = geometry(folder, warnings)?;
    framed_scene(folder, geometry.bounds(), geometry, vec![Material::grey()])
}

/// The same, seen from its middle where it cannot be framed.
pub(super) fn load_geometry(folder: &Path, warnings: &mut Warnings) -> Result<Scene, InputError> {
    let geometry = geometry(folder, warnings)?;
    let bounds = geometry.bounds();
    let framed = framed_scene(folder, bounds, Geometry::default(), vec![Material::grey()]);
    let (low, high) = bounds.unwrap_or_default();
    let eye = rounded_3((low + high) / 2.0);
    let middle = || {
        let mut scene = framed_scene(folder, None, Geometry::default(), vec![Material::grey()])?;
        (scene.camera.eye, scene.camera.target) = (eye, eye.with_z(eye.z.next_down()));
        Ok(scene)
    };
    Ok(Scene { geometry, ..framed.or_else(|_: InputError| middle())? })
}

fn geometry(folder: &Path, warnings: &mut Warnings) -> Result<Geometry, InputError> {
    let [vertices, triangles, spheres] =
        ["vertices.npy", "triangles.npy", "spheres.npy"].map(|name| folder.join(name));
    let mut geometry = Geometry::default();
    match (vertices.exists(), triangles.exists()) {
        (true, true) => {
            with_rows(&vertices, |rows| add_vertices(&vertices, rows, &mut geometry))?;
            with_rows(&triangles, |rows| add_triangles(&triangles, rows, &mut geometry, warnings))?;
        }
        (true, false) => {
            let message = "no triangles.npy is beside it, so nothing is made of these vertices; add it";
            return Err(refused(&vertices, message));
        }
        (false, true) => {
            let message =
                "no vertices.npy is beside it, whose rows are the corners of these triangles; add it";
            return Err(refused(&triangles, message));
        }
        (false, false) if !spheres.exists() => {
            let message = "a folder is a scene where vertices.npy and triangles.npy, or spheres.npy, are in it; none \
                           of them is in this one";
            return Err(refused(folder, message));
        }
        (false, false) => {}
    }
    if spheres.exists() {
        with_rows(&spheres, |rows| add_spheres(&spheres, rows, &mut geometry))?;
    }
    Ok(geometry)
}

fn add_vertices(path: &Path, rows: &[[f32; 3]], geometry: &mut Geometry) -> Result<(), InputError> {
    check_numbers(path, rows)?;
    let added = geometry.add_vertices(rows.iter().copied().map(Vec3::from_array));
    added.map(drop).map_err(|problem| refused(path, problem.to_string()))
}

fn add_triangles(
    path: &Path,
    rows: &[[u32; 3]],
    geometry: &mut Geometry,
    warnings: &mut Warnings,
) -> Result<(), InputError> {
    let vertices = geometry.vertices.len();
    geometry.triangles.reserve_exact(rows.len());
    for (row, &corners) in rows.iter().enumerate() {
        if let Some(beyond) = corners.into_iter().find(|&corner| corner as usize >= vertices) {
            let message =
                format!("vertex {beyond} is out of range; vertices.npy has {vertices} rows, counted from 0");
            return Err(refused_row(path, row, message));
        }
        let added = geometry.add_triangle(corners, None, GREY);
        if added.map_err(|problem| refused_row(path, row, problem.to_string()))? == Added::WithoutArea {
            warnings.add("without area", path, || {
                (place(row), "this triangle has no area and is left out".to_owned())
            });
        }
    }
    Ok(())
}

fn add_spheres(path: &Path, rows: &[[f32; 4]], geometry: &mut Geometry) -> Result<(), InputError> {
    check_numbers(path, rows)?;
    geometry.spheres.reserve_exact(rows.len());
    for (row, &[x, y, z, radius]) in rows.iter().enumerate() {
        let added = geometry.add_sphere(Vec3::new(x, y, z), radius, GREY);
        added.map_err(|problem| refused_row(path, row, problem.to_string()))?;
    }
    Ok(())
}

/// Hands over the rows of an array, which lie in the bytes of its file.
fn with_rows<T: npy::Element, const WIDTH: usize>(
    path: &Path,
    add: impl FnOnce(&[[T; WIDTH]]) -> Result<(), InputError>,
) -> Result<(), InputError> {
    let bytes = read_bytes(path)?;
    let array = npy::read(&bytes).map_err(|message| refused(path, message))?;
    add(array.rows().map_err(|message| refused(path, message))?)
}

fn check_numbers<const WIDTH: usize>(path: &Path, rows: &[[f32; WIDTH]]) -> Result<(), InputError> {
    for (row, numbers) in rows.iter().enumerate() {
        for &value in numbers {
            number::check(f64::from(value)).map_err(|message| refused_row(path, row, message))?;
        }
    }
    Ok(())
}

fn place(row: usize) -> Place {
    Place::Element(format!("row {row}"))
}

fn refused_row(path: &Path, row: usize, message: String) -> InputError {
    InputError::refused(path, place(row), message)
}

fn refused(path: &Path, message: impl Into<String>) -> InputError {
    InputError::refused(path, Place::File, message)
}
