//! Errors of recordings.

use std::{
    io,
    path::{Path, PathBuf},
};

/// Why a recording could not be made or read.
#[derive(Debug, thiserror::Error)]
pub enum RecorderError {
    /// The folder of an earlier recording is in the way.
    #[error(
        "cannot move the earlier recording {folder} aside to {aside}: {source}; move it away by hand, or record into another folder"
    )]
    MoveAside {
        /// The folder.
        folder: PathBuf,
        /// The path that it should have had.
        aside: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// Another recording is being made in the folder.
    #[error("a recording is being made in {folder}; record into another folder")]
    InUse {
        /// The folder.
        folder: PathBuf,
    },
    /// Another program writes in the folder's place.
    #[error("{0}")]
    Occupied(io::Error),
    /// Something else than a recording is in the folder.
    #[error(
        "{folder} holds something else than a recording, and stays as it is; record into a new folder"
    )]
    NoRecording {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder has lost its place while a recording was made in it.
    #[error(
        "{folder} was renamed, replaced or removed during the recording; leave it in its place until the recording is finished"
    )]
    Displaced {
        /// The folder.
        folder: PathBuf,
    },
    /// A folder that is to be read holds no recording of this program.
    #[error("{folder}: {found}")]
    NotThere {
        /// The folder.
        folder: PathBuf,
        /// What is there instead, and the way on.
        found: String,
    },
    /// A file has the name that the folder is to have.
    #[error("{path} is a file; record into a folder")]
    NoFolder {
        /// The file.
        path: PathBuf,
    },
    /// A file or folder cannot be made.
    #[error(
        "cannot create {path}: {source}; record into a folder that you may write to, on a disk with space left"
    )]
    Create {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A file or folder cannot be changed.
    #[error(
        "cannot write {path}: {source}; free some space on its disk, or record into another folder"
    )]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A command cannot be written.
    #[error("a command in tick {tick} cannot be written: {command}: {source}")]
    Command {
        /// The tick.
        tick: u64,
        /// The command, or how it begins.
        command: String,
        /// The reason.
        source: serde_json::Error,
    },
    /// An undo, a redo or an end was interrupted, and cannot be done now.
    #[error(
        "{folder}: a change that was interrupted when its recording was cut off cannot be finished now: {source}"
    )]
    Interrupted {
        /// The folder of the recording.
        folder: PathBuf,
        /// The reason.
        source: Box<RecorderError>,
    },
    /// Another program is undoing or redoing something in the recording.
    #[error("{folder}: another program is changing this recording; read it again later")]
    BeingChanged {
        /// The folder of the recording.
        folder: PathBuf,
    },
    /// A picture cannot be encoded.
    #[error(
        "cannot encode the picture {path}: {source}; check the size of the head camera's pictures"
    )]
    Picture {
        /// The picture's file.
        path: PathBuf,
        /// The reason.
        source: png::EncodingError,
    },
    /// A file cannot be read.
    #[error("cannot read {path}: {source}; check that the recording is complete and readable")]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// No simulation comes to a line of a session log.
    #[error("{path}:{line}: {problem}; the log was changed, or is damaged")]
    Course {
        /// The session log.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// The fault.
        problem: String,
    },
    /// The files hold content that no recorder writes.
    #[error("{folder}: {problem}; a file was changed, or is damaged")]
    Files {
        /// The folder of the recording.
        folder: PathBuf,
        /// The fault.
        problem: String,
    },
    /// A recording that is to be written holds what none may hold.
    #[error("{problem}; no recording can hold it")]
    Unfit {
        /// The fault.
        problem: String,
    },
    /// A line of another file is invalid.
    #[error("{path}:{line}: {problem}; the file was changed, or is damaged")]
    Line {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: u64,
        /// The fault.
        problem: String,
    },
    /// A line of a session log is invalid.
    #[error(
        "{path}:{line}: {source}; expected a session log of format {format}, as this program writes it",
        format = crate::files::format::FORMAT
    )]
    Session {
        /// The session log.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// The reason.
        source: serde_json::Error,
    },
    /// A session log has another format.
    #[error(
        "{path}: a session log of format {found}, this program reads format {format}; read it with the program of the version that its first line names",
        format = crate::files::format::FORMAT
    )]
    Format {
        /// The session log.
        path: PathBuf,
        /// Its format.
        found: u32,
    },
}

impl RecorderError {
    /// Whether the user's input is at fault, and not the disk.
    pub const fn is_of_input(&self) -> bool {
        match self {
            Self::MoveAside { .. }
            | Self::Occupied(_)
            | Self::Displaced { .. }
            | Self::Create { .. }
            | Self::Write { .. }
            | Self::Interrupted { .. }
            | Self::Picture { .. } => false,
            Self::InUse { .. }
            | Self::NoRecording { .. }
            | Self::NotThere { .. }
            | Self::NoFolder { .. }
            | Self::Command { .. }
            | Self::BeingChanged { .. }
            | Self::Read { .. }
            | Self::Course { .. }
            | Self::Files { .. }
            | Self::Unfit { .. }
            | Self::Line { .. }
            | Self::Session { .. }
            | Self::Format { .. } => true,
        }
    }

    pub(crate) fn create(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| match source.kind() == io::ErrorKind::ResourceBusy {
            true => Self::Occupied(source),
            false => Self::Create {
                path: path.to_owned(),
                source,
            },
        }
    }

    pub(crate) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Write {
            path: path.to_owned(),
            source,
        }
    }

    pub(crate) fn read(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Read {
            path: path.to_owned(),
            source,
        }
    }
}
