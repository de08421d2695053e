//! Answers of engines.

use std::time::Duration;

use crate::{
    error::EngineError,
    variables::{auxiliary::InitReply, motor::MotorCommand},
};

/// An answer of an engine: one for its start, one for each request, and one when it ends.
#[derive(Clone, Debug)]
pub enum Reply {
    /// The engine is there.
    Started {
        /// The engine's version and program.
        description: String,
    },
    /// The init script has run.
    Init(InitReply),
    /// The callback script has run.
    Step(Box<StepReply>),
    /// Something went wrong. If [`EngineError::is_fatal`], nothing more comes; else there may be another `EngineHandle::init`.
    Failed(EngineError),
}

/// The orders of a callback script.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReply {
    /// The command for the robot's motors.
    pub motor: MotorCommand,
    /// True if the script is done.
    pub exit: bool,
    /// The time from writing the request to having read the answer.
    pub took: Duration,
}
