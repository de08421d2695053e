//! Failures that end the program early.

use std::fmt;

/// Wrong usage or input.
pub(super) const WRONG_INPUT: u8 = 2;

/// The reason why the program ends early.
#[derive(Debug)]
pub(super) struct Failure {
    /// The message, unless it was already reported.
    pub message: Option<String>,
    pub code: u8,
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

    /// The run failed, and the reason was already reported.
    pub fn silent() -> Self {
        Self {
            message: None,
            code: 1,
        }
    }
}
