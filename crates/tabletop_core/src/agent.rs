//! The script that drives the robot, as the rest of the program sees it.

use std::time::Duration;

use bevy::prelude::*;

/// A command to the script bridge. It is none to the simulation: a recording holds the commands that come of the script, not
/// the script.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScriptCommand {
    /// Start the script engine and the script.
    Start,
    /// Stop the script.
    Stop,
}

/// An event in the life of the script.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum ScriptEvent {
    /// The engine is there and the init script runs.
    Started {
        /// The engine, with its version and program.
        engine: String,
    },
    /// The script has written this line.
    Printed {
        /// The line.
        line: String,
        /// Whether it was written as a warning or an error.
        is_error: bool,
    },
    /// The program remarks this about the script.
    Noted {
        /// The line.
        line: String,
    },
    /// The script has ended, by itself or on command.
    Stopped,
    /// The script or its engine has failed, and is stopped.
    Failed {
        /// What happened, and where.
        reason: String,
    },
}

/// What the script that drives the robot is doing (report section 5.2).
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub enum Agent {
    /// Nothing: there is none.
    #[default]
    Off,
    /// Its engine is coming up.
    Starting,
    /// It is called in every tick.
    Online {
        /// How long the last call took.
        took: Duration,
    },
    /// The simulation waits for it.
    Waiting {
        /// For how long it has.
        since: Duration,
    },
    /// It was stopped by an error.
    Failed,
}

impl Agent {
    /// Whether a script drives the robot.
    pub const fn is_on(&self) -> bool {
        matches!(
            self,
            Self::Starting | Self::Online { .. } | Self::Waiting { .. }
        )
    }
}

/// Whether something outside of the simulation is not ready, so that it stands still: no part of a tick runs.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct SimBlocked(pub bool);

impl SimBlocked {
    /// Run condition: nothing is waited for.
    pub fn is_clear(blocked: Res<Self>) -> bool {
        !blocked.0
    }
}
