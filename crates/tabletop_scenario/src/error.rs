//! What can be wrong with a scenario.

use std::path::PathBuf;

use crate::SourceLocation;

/// Why a scenario cannot be run, or has failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{path}: it cannot be read: {reason}", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        reason: String,
    },
    /// The text is not that of a scenario.
    #[error("{at}: {what}")]
    Syntax {
        /// Where.
        at: SourceLocation,
        /// What is wrong there.
        what: String,
    },
    /// A step asks for something that makes no sense.
    #[error("{at}: {step}: {what}")]
    Step {
        /// Where the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// What is wrong with it.
        what: String,
    },
    /// A task file cannot be loaded, or not be set up as the step asks for.
    #[error("{at}: {step}: {what}")]
    Setup {
        /// Where the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// What is wrong.
        what: String,
    },
    /// The scenario was run, and a step failed.
    #[error("{at}: {step}: {what}")]
    Failed {
        /// Where the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// What was expected and what was found.
        what: String,
    },
}
