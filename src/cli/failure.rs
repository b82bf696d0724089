//! Why a command did not do its work, and the exit code that says so.

use crate::film::FilmError;
use crate::load::{Cause, InputError};
use crate::render::RenderError;
use crate::report::FolderError;
use crate::save::SaveError;
use crate::scene::GeometryProblem;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// What a command ends in when it does not end well; its text is what the user reads.
#[derive(Debug, Error)]
pub(super) enum Failure {
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Film(#[from] FilmError),
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Report(#[from] FolderError),
    #[error(transparent)]
    Generate(#[from] GeometryProblem),
    #[error("{}: cannot be written: {why}", path.display())]
    Write { path: PathBuf, why: io::Error },
    #[error("{0}")]
    Usage(String),
    #[error("{0}")]
    Refused(String),
    #[error("{0}")]
    OverLimit(String),
}

impl Failure {
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::Input(error) => match error.cause {
                Cause::ReadFailed => 1,
                Cause::Refused => 3,
            },
            Self::Film(FilmError::Write { .. })
            | Self::Save(SaveError::Write { .. })
            | Self::Report(_)
            | Self::Write { .. } => 1,
            Self::Save(SaveError::UnknownFormat(_) | SaveError::CannotSay { .. }) | Self::Generate(_) => 2,
            Self::Film(FilmError::UnknownFormat(_)) | Self::Usage(_) => 2,
            Self::Film(FilmError::Open { .. } | FilmError::Content { .. }) | Self::Refused(_) => 3,
            Self::Render(RenderError::Region { .. } | RenderError::Pixel { .. }) => 2,
            Self::Render(RenderError::Prepare(_)) => 3,
            Self::Render(RenderError::Memory(_) | RenderError::Tree(_) | RenderError::Threads(_)) => 1,
            Self::Render(RenderError::Stopped) => 130,
            Self::OverLimit(_) => 4,
        }
    }
}
