//! Which file format a name asks for, and reading and writing in it.

use super::{Image, exr, npy, png};
use crate::whole_file;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The formats of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Clamped, sRGB, 8 or 16 bits.
    Png,
    /// Linear f32.
    Exr,
    /// Linear f32, (H, W, 3) in C order.
    Npy,
}

/// How many bits a channel of a PNG has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BitDepth {
    /// 0–255.
    #[default]
    Eight,
    /// 0–65535.
    Sixteen,
}

/// A picture file that cannot be written or read.
#[derive(Debug, Error)]
pub enum FilmError {
    /// The name says no format.
    #[error("{}: the name of a picture ends in .png, .exr or .npy", .0.display())]
    UnknownFormat(PathBuf),
    /// The system or the encoder refuses.
    #[error("{}: cannot be written: {why}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        why: io::Error,
    },
    /// The system refuses.
    #[error("{}: cannot be opened: {why}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system says.
        why: io::Error,
    },
    /// It is not what its name says, or not a picture.
    #[error("{}: {why}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong and what would be right.
        why: String,
    },
}

impl Format {
    /// The format that a name's ending asks for.
    ///
    /// # Errors
    /// No format of ours.
    pub fn of(path: &Path) -> Result<Self, FilmError> {
        let extension =
            path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            Some("npy") => Ok(Self::Npy),
            _ => Err(FilmError::UnknownFormat(path.to_owned())),
        }
    }

    /// Whether the file keeps linear values; a PNG keeps sRGB codes.
    #[must_use]
    pub fn is_linear(self) -> bool {
        self != Self::Png
    }
}

/// Writes a picture in the format of its name, whole or not at all.
///
/// # Errors
/// An unknown ending, or a file that cannot be written.
pub fn write(image: &Image, path: &Path, depth: BitDepth) -> Result<(), FilmError> {
    let format = Format::of(path)?;
    whole_file::write(path, |writer| match format {
        Format::Png => png::write(image, depth, writer),
        Format::Exr => exr::write(image, writer),
        Format::Npy => npy::write(image, writer),
    })
    .map_err(|why| FilmError::Write { path: path.to_owned(), why })
}

/// Says early whether [`write()`] could put a file there.
///
/// # Errors
/// An unknown ending, or a place where no file can be made.
pub fn check_writable(path: &Path) -> Result<(), FilmError> {
    Format::of(path)?;
    whole_file::probe(path).map_err(|why| FilmError::Write { path: path.to_owned(), why })
}

/// Reads a picture: linear values from EXR and NPY, sRGB values 0–1 from PNG.
///
/// # Errors
/// A file that cannot be opened, or is not a picture in the format of its name.
pub fn read(path: &Path) -> Result<Image, FilmError> {
    let content = |why: String| FilmError::Content { path: path.to_owned(), why };
    let format =
        Format::of(path).map_err(|_| content("a picture to read ends in .png, .exr or .npy".into()))?;
    let bytes = std::fs::read(path).map_err(|why| FilmError::Open { path: path.to_owned(), why })?;
    match format {
        Format::Png => png::read(&bytes),
        Format::Exr => exr::read(&bytes),
        Format::Npy => npy::read(&bytes),
    }
    .map_err(content)
}
