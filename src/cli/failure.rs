//! Failures that end the program early.

use std::{fmt, io, path::Path};

use crate::recorder::RecorderError;

use super::terminal::say;

/// Wrong usage or input.
pub(super) const WRONG_INPUT: u8 = 2;

/// The reason why the program ends early.
#[derive(Debug)]
pub(super) struct Failure {
    /// The message, unless it was already reported.
    pub message: Option<String>,
    pub code: u8,
}

impl From<RecorderError> for Failure {
    fn from(error: RecorderError) -> Self {
        Self::run(error)
    }
}

impl Failure {
    /// The user's input is at fault.
    pub fn input(error: impl fmt::Display) -> Self {
        Self {
            message: Some(error.to_string()),
            code: WRONG_INPUT,
        }
    }

    /// The run failed.
    pub fn run(error: impl fmt::Display) -> Self {
        Self {
            message: Some(error.to_string()),
            code: 1,
        }
    }

    /// A file or folder cannot be read or changed.
    pub fn at(path: &Path, error: io::Error) -> Self {
        Self::run(format!("{}: {error}", path.display()))
    }

    /// The first failure of several parts of a run; the others are reported.
    pub fn of_all(results: impl IntoIterator<Item = Result<(), Self>>) -> Result<(), Self> {
        let mut failures = results.into_iter().filter_map(Result::err);
        let Some(first) = failures.next() else {
            return Ok(());
        };
        for other in failures.filter_map(|failure| failure.message) {
            say(format_args!("tabletop: {other}"));
        }
        Err(first)
    }

    /// The same, without a message that this text has reported already.
    pub fn unless_said(self, said: &str) -> Self {
        Self {
            message: self.message.filter(|message| !said.contains(message)),
            ..self
        }
    }

    /// The run failed, and the reason was already reported.
    pub fn silent() -> Self {
        Self {
            message: None,
            code: 1,
        }
    }
}
