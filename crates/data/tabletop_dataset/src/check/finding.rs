//! What is wrong with a dataset.

use std::{fmt, path::PathBuf};

/// Something that is wrong with a dataset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The recording, file or episode.
    pub place: PathBuf,
    /// What is wrong.
    pub problem: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place.display(), self.problem)
    }
}

/// What was found so far, and the place that is being checked.
#[derive(Debug, Default)]
pub(super) struct Findings {
    pub(super) place: PathBuf,
    pub(super) found: Vec<Finding>,
}

impl Findings {
    pub(super) fn add(&mut self, problem: impl ToString) {
        self.found.push(Finding {
            place: self.place.clone(),
            problem: problem.to_string(),
        });
    }
}
