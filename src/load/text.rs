//! A file read as text, and where in it something is.

use super::error::{Cause, InputError, Place, Warnings};
use crate::scene::{Added, GeometryProblem};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The bytes of a file.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>, InputError> {
    let refused = |why: &dyn std::fmt::Display| {
        InputError::refused(path, Place::File, format!("cannot be opened: {why}; check the name"))
    };
    let mut file = File::open(path).map_err(|why| refused(&why))?;
    if path.is_dir() {
        return Err(refused(&"it is a folder"));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|why| InputError {
        path: path.to_owned(),
        place: Place::File,
        message: format!("reading it failed midway: {why}"),
        cause: Cause::ReadFailed,
    })?;
    Ok(bytes)
}

/// A text file.
pub(super) struct Text {
    pub(super) path: PathBuf,
    pub(super) content: String,
}

impl Text {
    /// Reads a file that must be UTF-8.
    pub(super) fn read(path: &Path) -> Result<Self, InputError> {
        String::from_utf8(read_bytes(path)?).map(|content| Self::new(path, content)).map_err(|error| {
            let (good, bad) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
            let text = Self::new(path, String::from_utf8_lossy(good).into_owned());
            let message = format!("byte 0x{:02x} is not UTF-8 text; is this a binary file?", bad[0]);
            text.error(text.content.len(), message)
        })
    }

    /// Reads a file whose comments may be in any encoding; outside them what is not UTF-8 means nothing to any format.
    pub(super) fn read_lossy(path: &Path) -> Result<Self, InputError> {
        let content = String::from_utf8(read_bytes(path)?)
            .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned());
        Ok(Self::new(path, content))
    }

    /// A byte order mark is passed over.
    fn new(path: &Path, mut content: String) -> Self {
        if content.starts_with('\u{feff}') {
            content.remove(0);
        }
        Self { path: path.to_owned(), content }
    }

    /// Line and column of a byte offset.
    pub(super) fn place(&self, offset: usize) -> Place {
        let start = (0..=offset.min(self.content.len())).rev().find(|&at| self.content.is_char_boundary(at));
        let before = &self.content[..start.unwrap_or(0)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place::At {
            line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// Refuses what is at a byte offset.
    pub(super) fn error(&self, offset: usize, message: impl Into<String>) -> InputError {
        InputError::refused(&self.path, self.place(offset), message)
    }

    /// Warns about what is at a byte offset.
    pub(super) fn warn(
        &self,
        warnings: &mut Warnings,
        kind: &str,
        offset: usize,
        message: impl FnOnce() -> String,
    ) {
        warnings.add(kind, &self.path, || (self.place(offset), message()));
    }

    /// Refuses a primitive that begins at a byte offset, or warns of what became of it.
    pub(super) fn added(
        &self,
        offset: usize,
        added: Result<Added, GeometryProblem>,
        warnings: &mut Warnings,
    ) -> Result<(), InputError> {
        match added {
            Err(problem) => return Err(self.error(offset, problem.to_string())),
            Ok(Added::Flat) => {}
            Ok(Added::WithoutArea) => {
                self.warn(warnings, "without area", offset, || {
                    "this shape has no area and is left out".to_owned()
                });
            }
            Ok(Added::Bent { off_plane }) => {
                self.warn(warnings, "bent", offset, || {
                    format!(
                        "this polygon is not quite planar: a vertex lies {off_plane:.1e} of the polygon's extent off \
                         its plane, and neighbours may not meet exactly"
                    )
                });
            }
        }
        Ok(())
    }
}
