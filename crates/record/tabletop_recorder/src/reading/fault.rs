//! Faults in the lines of a recording's files.

use std::path::{Path, PathBuf};

use crate::error::RecorderError;

/// The error for a line of a recording's file.
pub(super) fn damaged(path: &Path, line: u64, problem: impl ToString) -> RecorderError {
    RecorderError::Line {
        path: PathBuf::from(path),
        line,
        problem: problem.to_string(),
    }
}
