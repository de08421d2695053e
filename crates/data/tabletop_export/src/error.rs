//! Errors of exports.

use std::{io, path::PathBuf};

use tabletop_film::FilmError;
use tabletop_training::EpisodeError;
use thiserror::Error;

/// The error of an export.
#[derive(Debug, Error)]
pub enum ExportError {
    /// A recording cannot be read as an episode.
    #[error(transparent)]
    Episode(Box<EpisodeError>),
    /// A video cannot be encoded or decoded.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// A recording does not fit the dataset.
    #[error("{}: {problem}", .recording.display())]
    Unfit {
        /// Its folder.
        recording: PathBuf,
        /// The reason.
        problem: String,
    },
    /// A file of the dataset is not what this program writes.
    #[error("{}: {problem}", .path.display())]
    Dataset {
        /// The file.
        path: PathBuf,
        /// Its fault.
        problem: String,
    },
    /// A file cannot be read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

impl From<EpisodeError> for ExportError {
    fn from(error: EpisodeError) -> Self {
        Self::Episode(Box::new(error))
    }
}

impl ExportError {
    /// Whether the user's input is at fault, and not the disk.
    pub fn is_of_input(&self) -> bool {
        match self {
            Self::Episode(error) => error.is_of_input(),
            Self::Film(_) | Self::Unfit { .. } | Self::Dataset { .. } => true,
            Self::Io { .. } => false,
        }
    }

    pub(crate) fn io(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        |source| Self::Io { path, source }
    }

    pub(crate) fn dataset(path: impl Into<PathBuf>, problem: impl ToString) -> Self {
        Self::Dataset {
            path: path.into(),
            problem: problem.to_string(),
        }
    }
}
