//! Errors of datasets.

use std::{io, path::PathBuf};

use tabletop_export::ExportError;
use tabletop_recorder::RecorderError;
use tabletop_replay::ReplayError;
use tabletop_training::EpisodeError;

/// The error of a dataset, or of a recording that is to be one of it.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    /// A recording cannot be read or written.
    #[error(transparent)]
    Recording(#[from] RecorderError),
    /// A dataset cannot be read or written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A recording cannot be read as an episode.
    #[error(transparent)]
    Episode(#[from] EpisodeError),
    /// A recording cannot be simulated again.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A folder holds something else.
    #[error("{}: {problem}", .path.display())]
    Unfit {
        /// The folder or file.
        path: PathBuf,
        /// What is wrong with it, and what was expected.
        problem: String,
    },
    /// A file cannot be read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

impl DatasetError {
    /// Whether the user's input is at fault, and not the disk.
    pub fn is_of_input(&self) -> bool {
        match self {
            Self::Recording(error) => error.is_of_input(),
            Self::Export(error) => error.is_of_input(),
            Self::Episode(error) => error.is_of_input(),
            Self::Replay(error) => !matches!(error, ReplayError::Record(_)),
            Self::Unfit { .. } => true,
            Self::Io { .. } => false,
        }
    }

    pub(crate) fn io(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        |source| Self::Io { path, source }
    }

    pub(crate) fn unfit(path: impl Into<PathBuf>, problem: impl ToString) -> Self {
        Self::Unfit {
            path: path.into(),
            problem: problem.to_string(),
        }
    }
}
