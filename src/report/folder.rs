//! The folder of a page: files that appear whole, the page last.

use super::Compared;
use super::figures::{HIT_ERRORS, SPEED_BY_KIND, SPEED_OVER_ERROR};
use super::html::GENERATOR;
use super::page::{ENGINE, ENGINE_ERROR, FLOOR_ERROR, Page, TRUTH};
use super::rung_figures::{POLYGON_FORMULAS, SAMPLES, SPHERE_FORMULAS, TRIANGLE_FORMULAS, WEAK_RAYS};
use crate::film::{self, BitDepth, FilmError};
use crate::measure::ComparedImages;
use crate::whole_file;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const PAGE: &str = "index.html";
const DATA: &str = "comparison.json";
/// All that is ever written.
const FILES: [&str; 14] = [
    PAGE,
    DATA,
    SPEED_OVER_ERROR,
    SPEED_BY_KIND,
    HIT_ERRORS,
    SPHERE_FORMULAS,
    TRIANGLE_FORMULAS,
    POLYGON_FORMULAS,
    WEAK_RAYS,
    SAMPLES,
    TRUTH,
    ENGINE,
    ENGINE_ERROR,
    FLOOR_ERROR,
];

/// A folder that a page can be written to.
pub(crate) struct Folder {
    path: PathBuf,
    /// Whether it was not there before.
    is_new: bool,
}

/// A folder that was made for nothing goes away again.
impl Drop for Folder {
    fn drop(&mut self) {
        if self.is_new {
            // Of one that is not empty there is something to keep.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

/// A page that cannot be written.
#[derive(Debug, Error)]
pub(crate) enum FolderError {
    #[error("{}: cannot be written: {why}", path.display())]
    Write { path: PathBuf, why: io::Error },
    #[error(transparent)]
    Picture(#[from] FilmError),
    #[error(
        "{}: this is not of an earlier report, and a report would replace it; choose another folder, or move it away", .0.display()
    )]
    NotOurs(PathBuf),
}

impl Folder {
    /// Makes the folder if need be, and finds out early whether all of the files can be written there.
    ///
    /// What else is in it stays. Files of the names that are needed are replaced where the folder holds an earlier page;
    /// without one they are somebody else's.
    ///
    /// # Errors
    /// No folder can be made, no file can be made in it, or one would replace somebody else's.
    pub(crate) fn open(path: &Path) -> Result<Self, FolderError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            |why| FolderError::Write { path, why }
        };
        let is_new = !path.exists();
        fs::create_dir_all(path).map_err(failed(path))?;
        let folder = Self { path: path.to_owned(), is_new };
        let is_ours = fs::read_to_string(path.join(PAGE)).is_ok_and(|page| page.contains(GENERATOR));
        for file in folder.files() {
            if !is_ours && file.is_file() {
                return Err(FolderError::NotOurs(file));
            }
            whole_file::probe(&file).map_err(failed(&file))?;
        }
        Ok(folder)
    }

    /// What a browser opens.
    pub(crate) fn page(&self) -> PathBuf {
        self.path.join(PAGE)
    }

    /// The files that may be written.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> + '_ {
        FILES.iter().map(|name| self.path.join(name))
    }

    /// Writes all of them, the page last: where it is, all that it shows is there too. What an earlier page showed and this one
    /// does not is removed.
    ///
    /// # Errors
    /// The file that cannot be written.
    pub(crate) fn write(&self, compared: &Compared, images: ComparedImages) -> Result<(), FolderError> {
        let failed = |name: &str, why| FolderError::Write { path: self.path.join(name), why };
        let page =
            Page::new(compared, images, DATA).map_err(|error| failed(PAGE, io::Error::other(error)))?;
        let data = serde_json::to_string_pretty(compared).map_err(|error| failed(DATA, error.into()))?;
        self.text(DATA, &(data + "\n"))?;
        for figure in &page.figures {
            self.text(figure.file, &figure.svg)?;
        }
        for picture in &page.pictures {
            film::write(&picture.image, &self.path.join(picture.file), BitDepth::Eight)?;
        }
        self.text(PAGE, &page.html)?;
        let shown = page.files();
        let left = FILES.iter().filter(|name| ![PAGE, DATA].contains(name) && !shown.contains(name));
        left.map(|name| self.path.join(name)).try_for_each(|path| match fs::remove_file(&path) {
            Err(why) if why.kind() != io::ErrorKind::NotFound => Err(FolderError::Write { path, why }),
            _ => Ok(()),
        })
    }

    fn text(&self, name: &str, text: &str) -> Result<(), FolderError> {
        let path = self.path.join(name);
        let written = whole_file::write(&path, |writer| writer.write_all(text.as_bytes()));
        written.map_err(|why| FolderError::Write { path, why })
    }
}
