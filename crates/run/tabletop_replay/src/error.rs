//! Errors of recordings that cannot be replayed.

use std::{io, path::PathBuf};

use tabletop_recorder::RecorderError;

/// The error of a recording that cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// Its session log cannot be read.
    #[error(transparent)]
    Session(#[from] RecorderError),
    /// Its session log does not go back far enough.
    #[error(
        "{}:1: begin_tick: the commands before the recording are not known, so it cannot be run again; \
         load a task file before the recording starts",
        path.display()
    )]
    NoBeginning {
        /// The session log.
        path: PathBuf,
    },
    /// It was imported.
    #[error(
        "{}: it was made from {from}, so there are no commands to simulate again; explain, imitate, multiply, export and the \
         window read it",
        folder.display()
    )]
    Imported {
        /// Its folder.
        folder: PathBuf,
        /// Where it comes from, such as `pictures`.
        from: String,
    },
    /// It was made with settings that this program does not have.
    #[error("{}:1: {name}: {problem}; it was recorded with version {program}, this is {}", path.display(), env!("CARGO_PKG_VERSION"))]
    Settings {
        /// The session log.
        path: PathBuf,
        /// The setting.
        name: &'static str,
        /// Its fault.
        problem: String,
        /// The version of the program that made the recording.
        program: String,
    },
    /// The recording of the replay could not begin or go on.
    #[error("{0}")]
    Record(String),
    /// A file of one of the recordings cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
}
