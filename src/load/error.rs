//! What a loader says about a file: one error, or warnings, each with its place.

use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line and a column, both counted from 1, the column in characters.
    At {
        /// Line.
        line: usize,
        /// Column.
        column: usize,
    },
    /// The element, such as `face 12`, of a file read by a library that gives no line, counted from 1; or the row
    /// of an array, such as `row 12`, counted from 0.
    Element(String),
}

/// Whether the input is at fault or the reading of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The input cannot be opened, parsed or accepted.
    Refused,
    /// The input was opened, and then reading it failed.
    ReadFailed,
}

/// Why there is no scene: `FILE:LINE:COLUMN: what is wrong; what would be right`.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}{message}", Located(path, place))]
pub struct InputError {
    /// The file as the user or another file named it.
    pub path: PathBuf,
    /// Where in it.
    pub place: Place,
    /// What is wrong and what would be right.
    pub message: String,
    /// Whether the input is at fault.
    pub cause: Cause,
}

impl InputError {
    pub(super) fn refused(path: &Path, place: Place, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), place, message: message.into(), cause: Cause::Refused }
    }
}

/// Something that the user should know of a scene that was read: `FILE:LINE:COLUMN: warning: what`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file.
    pub path: PathBuf,
    /// Where the first of its kind is.
    pub place: Place,
    /// What happened.
    pub message: String,
    /// How many of its kind there are.
    pub count: u64,
}

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}warning: {}", Located(&self.path, &self.place), self.message)?;
        match self.count {
            0 | 1 => Ok(()),
            count => write!(f, " ({count} in all; this is the first)"),
        }
    }
}

/// `FILE:LINE:COLUMN: `, `FILE: face 12: ` or `FILE: `.
struct Located<'a>(&'a Path, &'a Place);

impl Display for Located<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let path = self.0.display();
        match self.1 {
            Place::File => write!(f, "{path}: "),
            Place::At { line, column } => write!(f, "{path}:{line}:{column}: "),
            Place::Element(element) => write!(f, "{path}: {element}: "),
        }
    }
}

/// Collects warnings, each kind once with a count.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    list: Vec<(String, Warning)>,
}

impl Warnings {
    /// Warns, or counts one more where the same file was warned of the same kind before.
    /// Only the first of a kind is asked for its place and message: finding a line takes a look at all lines before it.
    pub(super) fn add(&mut self, kind: &str, path: &Path, first: impl FnOnce() -> (Place, String)) {
        let same = |(known, warning): &&mut (String, Warning)| known == kind && warning.path == path;
        match self.list.iter_mut().find(same) {
            Some((_, warning)) => warning.count += 1,
            None => {
                let (place, message) = first();
                let warning = Warning { path: path.to_owned(), place, message, count: 1 };
                self.list.push((kind.to_owned(), warning));
            }
        }
    }

    pub(super) fn into_list(self) -> Vec<Warning> {
        self.list.into_iter().map(|(_, warning)| warning).collect()
    }
}
