//! Why the program ends before it is done.

use std::fmt;

/// Wrong usage or input.
pub(super) const WRONG_INPUT: u8 = 2;

/// Why the program ends before it is done.
#[derive(Debug)]
pub(super) struct Failure {
    /// What is wrong, if nobody has said it yet.
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

    /// The run failed, and there is nothing more to say.
    pub fn silent() -> Self {
        Self {
            message: None,
            code: 1,
        }
    }
}
