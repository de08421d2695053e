//! Destinations of results.

use std::{
    io::{self, ErrorKind, IsTerminal as _, Write as _},
    path::PathBuf,
};

use crate::storage::Storage;

use super::{
    Failure,
    result_file::{ResultFile, ResultKind},
    terminal::printable,
};

/// A path, or `-` for standard output.
#[derive(Clone, Debug)]
pub(super) enum Output {
    Stdout,
    File(PathBuf),
}

impl From<std::ffi::OsString> for Output {
    fn from(name: std::ffi::OsString) -> Self {
        match name.to_str() {
            Some("-") => Self::Stdout,
            _ => Self::File(name.into()),
        }
    }
}

impl Output {
    /// Checks that a result of this kind can be written there, without leaving a trace.
    pub fn check(&self, kind: ResultKind) -> Result<(), Failure> {
        match self {
            Self::Stdout => Ok(()),
            Self::File(path) => ResultFile::replacing(path, kind).map(drop),
        }
    }

    /// Writes sentences for the user to standard output. Names in them may be a stranger's, so what a terminal would obey is escaped.
    pub fn tell(text: &str) -> Result<(), Failure> {
        Self::Stdout.write(printable(text).as_bytes())
    }

    /// Writes everything, or reports the place that could not be written; a file is then as it was.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Stdout => {
                let mut stdout = io::stdout().lock();
                let text = String::from_utf8_lossy(bytes);
                let written = match stdout.is_terminal() {
                    true => stdout.write_all(printable(&text).as_bytes()),
                    false => stdout.write_all(bytes),
                };
                let written = written.and_then(|()| stdout.flush());
                written.map_err(|error| {
                    if error.kind() == ErrorKind::BrokenPipe {
                        Failure::silent()
                    } else {
                        Failure::run(format!("standard output: {error}"))
                    }
                })
            }
            Self::File(path) => Storage::default()
                .replace(path, bytes)
                .map_err(|error| Failure::at(path, error)),
        }
    }
}
