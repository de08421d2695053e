//! Errors of scenarios.

use std::path::PathBuf;

use crate::SourceLocation;

/// The error of a scenario that cannot be run, or has failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{path}: it cannot be read: {reason}", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The operating system's message.
        reason: String,
    },
    /// The text is not that of a scenario.
    #[error("{at}: {what}")]
    Syntax {
        /// The place of the fault.
        at: SourceLocation,
        /// The fault.
        what: String,
    },
    /// A step asks for something that makes no sense.
    #[error("{at}: {step}: {what}")]
    Step {
        /// The place in which the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// The fault.
        what: String,
    },
    /// A task file cannot be loaded, or cannot be set up as the step asks.
    #[error("{at}: {step}: {what}")]
    Setup {
        /// The place in which the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// The fault.
        what: String,
    },
    /// The scenario was run, and a step failed.
    #[error("{at}: {step}: {what}")]
    Failed {
        /// The place in which the step begins.
        at: SourceLocation,
        /// Its text.
        step: String,
        /// The expectation and the finding.
        what: String,
    },
}
