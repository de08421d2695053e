//! What comes back from an engine.

use std::time::Duration;

use crate::{
    error::EngineError,
    variables::{auxiliary::InitReply, motor::MotorCommand},
};

/// What comes back from an engine: one for its start, one for each request, and one when it ends.
#[derive(Clone, Debug)]
pub enum Reply {
    /// The engine is there.
    Started {
        /// Which one, with its version and program.
        description: String,
    },
    /// The init script has run.
    Init(InitReply),
    /// The callback script has run.
    Step(Box<StepReply>),
    /// Something went wrong. If [`EngineError::is_fatal`], nothing more comes; else there may be another `EngineHandle::init`.
    Failed(EngineError),
}

/// What a callback script wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReply {
    /// What the robot shall do.
    pub motor: MotorCommand,
    /// Whether the script is done.
    pub exit: bool,
    /// How long it took, from writing the request to having read the answer.
    pub took: Duration,
}
