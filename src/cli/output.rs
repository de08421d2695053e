//! Destinations of results.

use std::{
    fs,
    io::{self, ErrorKind, IsTerminal as _, Write as _},
    path::PathBuf,
};

use super::{Failure, terminal::printable};

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
    /// Checks that it can be written, without leaving a trace.
    pub fn check(&self) -> Result<(), Failure> {
        let Self::File(path) = self else {
            return Ok(());
        };
        // Opening and closing a pipe would signal its end to the reader.
        if path.exists() && !path.is_file() && !path.is_dir() {
            return Ok(());
        }
        let is_new = path.symlink_metadata().is_err();
        let mut options = fs::OpenOptions::new();
        let opened = options.append(true).create(true).open(path);
        opened
            .and_then(|_| match is_new {
                true => fs::remove_file(path),
                false => Ok(()),
            })
            .map_err(|error| Failure::run(format!("{}: {error}", path.display())))
    }

    /// Writes everything, or reports the place that could not be written.
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
            Self::File(path) => fs::write(path, bytes)
                .map_err(|error| Failure::run(format!("{}: {error}", path.display()))),
        }
    }
}
