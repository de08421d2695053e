//! Errors of training episodes.

use std::{io, path::PathBuf};

use tabletop_film::FilmError;
use tabletop_recorder::RecorderError;
use tabletop_replay::ReplayError;
use tabletop_task::RequirementError;
use thiserror::Error;

/// A recording that cannot be read as a learner reads it.
#[derive(Debug, Error)]
pub enum EpisodeError {
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecorderError),
    /// The requirements of its task cannot be read.
    #[error(transparent)]
    Requirements(#[from] RequirementError),
    /// It cannot be simulated again.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// Its pictures cannot be made.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// It lacks what was asked for.
    #[error("{}: {problem}", .recording.display())]
    Unfit {
        /// Its folder.
        recording: PathBuf,
        /// The reason.
        problem: String,
    },
    /// A file is no picture of its camera.
    #[error("{}: {problem}", .path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// Its fault.
        problem: String,
    },
    /// A file cannot be read.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

impl EpisodeError {
    /// Whether the user's input is at fault, and not the disk.
    pub const fn is_of_input(&self) -> bool {
        match self {
            Self::Recording(_)
            | Self::Requirements(_)
            | Self::Replay(_)
            | Self::Film(_)
            | Self::Unfit { .. }
            | Self::Picture { .. } => true,
            Self::Io { .. } => false,
        }
    }

    pub(crate) fn io(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        |source| Self::Io { path, source }
    }

    pub(crate) fn picture(path: impl Into<PathBuf>, problem: impl ToString) -> Self {
        Self::Picture {
            path: path.into(),
            problem: problem.to_string(),
        }
    }
}
