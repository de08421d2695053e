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
    /// Several of these, a line each.
    #[error("{}", lines(.0))]
    Several(Vec<Self>),
}

/// The most faults of a scenario that are looked for.
const MOST_FAULTS: usize = 200;

impl ScenarioError {
    /// All results, or all their faults.
    pub(crate) fn of_all<T>(
        results: impl IntoIterator<Item = Result<T, Self>>,
    ) -> Result<Vec<T>, Self> {
        let (mut done, mut faults) = (Vec::new(), Vec::new());
        for result in results {
            match result {
                Ok(it) => done.push(it),
                Err(fault) => faults.push(fault),
            }
            if faults.len() >= MOST_FAULTS {
                break;
            }
        }
        match faults.len() {
            0 => Ok(done),
            1 => Err(faults.remove(0)),
            _ => Err(Self::Several(faults)),
        }
    }
}

fn lines(faults: &[ScenarioError]) -> String {
    let lines: Vec<_> = faults.iter().map(ToString::to_string).collect();
    lines.join("\n")
}
