//! Errors of learning.

use std::{
    io,
    path::{Path, PathBuf},
};

use tabletop_episodes::multiplication::MultiplyError;
use tabletop_wire::WireError;

/// The error of learning, or of a policy's file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum PolicyError {
    #[error(transparent)]
    Multiply(#[from] MultiplyError),
    #[error(
        "step {0}: a policy can only put objects somewhere, not remove them, keep them in the hand or let them fall"
    )]
    NoPlace(usize),
    #[error("the task has {0} different heights, more than the {most} that a policy tells apart", most = crate::label::MOST_LEVELS)]
    TooManyLevels(usize),
    #[error("the head camera nowhere sees all objects of the task at once")]
    NothingSeen,
    #[error("{path}: {fault}", path = .path.display())]
    Damaged { path: PathBuf, fault: String },
    #[error("{path}: it was learned from another demonstration or with other options; name another file", path = .path.display())]
    OtherCurriculum { path: PathBuf },
    #[error(transparent)]
    Wire(#[from] WireError),
    #[error("{path}: {source}", path = .path.display())]
    Io { path: PathBuf, source: io::Error },
}

impl PolicyError {
    pub(crate) fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }

    pub(crate) fn damaged(path: &Path) -> impl FnOnce(String) -> Self {
        |fault| Self::Damaged {
            path: path.to_owned(),
            fault,
        }
    }
}
