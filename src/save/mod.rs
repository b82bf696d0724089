//! Scene files, written: a file a format. What [`load`](crate::load) reads back is the same scene: the same primitives under
//! the same numbers, and every number to the last bit. What a format cannot say is refused, never left out.
//!
//! Two things may differ, which no picture shows: each triangle and polygon gets vertices of its own, and a primitive that
//! was left out for want of an area, and keeps its number, has all of them at the origin.
//!
//! - `toml`, `nff`: the formats; each first makes sure that the scene can be said, then writes
//! - `shapes`: primitives in the order of their numbers; `number`: digits

mod nff;
mod number;
mod shapes;
mod toml;

use crate::scene::Scene;
use crate::whole_file;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The formats of scene files that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The project's own.
    Toml,
    /// Haines' Neutral File Format.
    Nff,
}

/// A scene file that cannot be written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The name says no format.
    #[error("{}: the name of a scene file to write ends in .toml or .nff", .0.display())]
    UnknownFormat(PathBuf),
    /// The format has no words for something in the scene.
    #[error("{}: {what}", path.display())]
    CannotSay {
        /// The file.
        path: PathBuf,
        /// The first thing that cannot be said, and what to do instead.
        what: String,
    },
    /// The system refuses.
    #[error("{}: cannot be written: {why}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        why: io::Error,
    },
}

impl Format {
    /// The format that a name's ending asks for.
    ///
    /// # Errors
    /// No format that can be written.
    pub fn of(path: &Path) -> Result<Self, SaveError> {
        let extension =
            path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("toml") => Ok(Self::Toml),
            Some("nff") => Ok(Self::Nff),
            _ => Err(SaveError::UnknownFormat(path.to_owned())),
        }
    }
}

/// Writes a scene in the format of the file's name, whole or not at all.
///
/// # Errors
/// An unknown ending, a scene that the format cannot say, or a file that cannot be written.
pub fn save(scene: &Scene, path: &Path) -> Result<(), SaveError> {
    let cannot_say = |what| SaveError::CannotSay { path: path.to_owned(), what };
    let written = match Format::of(path)? {
        Format::Toml => {
            let document = toml::Document::new(scene).map_err(cannot_say)?;
            whole_file::write(path, |writer| document.write(writer))
        }
        Format::Nff => {
            let document = nff::Document::new(scene).map_err(cannot_say)?;
            whole_file::write(path, |writer| document.write(writer))
        }
    };
    written.map_err(|why| SaveError::Write { path: path.to_owned(), why })
}

/// Says early whether [`save`] could put a file there.
///
/// # Errors
/// An unknown ending, or a place where no file can be made.
pub fn check_writable(path: &Path) -> Result<(), SaveError> {
    Format::of(path)?;
    whole_file::probe(path).map_err(|why| SaveError::Write { path: path.to_owned(), why })
}
