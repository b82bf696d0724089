//! Scene files: a file a format; all end in a [`Scene`] or in an error that says where, what, and what would be right.
//!
//! - `text`: a file as text, with lines and columns; `words`: its words; `number`: what a number may be
//! - `toml`: the project's own format; `nff`: Haines' Neutral File Format
//! - `mesh`: OBJ with MTL, and PLY, alone or as parts of a scene
//! - `rays`: recorded rays
//! - `folder`: a folder of NPY arrays
//! - `framing`: the camera and the light of a file that has none

mod error;
mod folder;
mod framing;
mod mesh;
mod nff;
mod number;
mod rays;
mod suggest;
mod text;
mod toml;
mod words;

pub use error::{Cause, InputError, Place, Warning};
pub use rays::rays;

use crate::scene::Scene;
use error::Warnings;
use mesh::MeshFormat;
use std::path::Path;

/// A scene, and what its user should know about it.
#[derive(Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What was read but not kept, or looks like a mistake; in order of appearance, each kind once.
    pub warnings: Vec<Warning>,
}

/// Reads a scene file in the format of its name's ending, `.toml`, `.nff`, `.obj` or `.ply`, or a folder of `.npy` arrays.
///
/// # Errors
/// The first thing in the file, or in a file that it names, that cannot be opened, parsed or accepted.
pub fn load(path: &Path) -> Result<Loaded, InputError> {
    const KNOWN: &str =
        "a scene is a file that ends in .toml, .nff, .obj or .ply, or a folder of .npy arrays";
    let refused = |message: String| Err(InputError::refused(path, Place::File, message));
    let mut warnings = Warnings::default();
    let scene = match (extension(path).as_deref(), MeshFormat::of(path)) {
        _ if path.is_dir() => folder::load(path, &mut warnings),
        (Some("toml"), _) => toml::load(path, &mut warnings),
        (Some("nff"), _) => nff::load(path, &mut warnings),
        (_, Some(format)) => mesh::load_alone(path, format, &mut warnings),
        (Some(other), _) => refused(format!("unknown ending `.{other}`; {KNOWN}")),
        (None, _) => refused(format!("this is no folder, and the name has no ending; {KNOWN}")),
    }?;
    Ok(Loaded { scene, warnings: warnings.into_list() })
}

/// The same for tracing recorded rays, which takes no camera: what is too small to be framed can be traced.
///
/// # Errors
/// As those of [`load`].
pub fn load_geometry(path: &Path) -> Result<Loaded, InputError> {
    if !path.is_dir() {
        return load(path);
    }
    let mut warnings = Warnings::default();
    let scene = folder::load_geometry(path, &mut warnings)?;
    Ok(Loaded { scene, warnings: warnings.into_list() })
}

/// A name's ending in lower case, without the dot.
fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}
