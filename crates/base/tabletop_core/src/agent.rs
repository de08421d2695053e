//! The script that drives the robot, as the rest of the program sees it.

use std::time::Duration;

use bevy::prelude::*;

/// A command to the script bridge. It is not a command to the simulation: a recording holds the commands that the script gives, not the script.
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
        /// A line that the script wrote.
        line: String,
        /// True if it was written as a warning or an error.
        is_error: bool,
    },
    /// A remark of the program about the script.
    Noted {
        /// The line.
        line: String,
    },
    /// The script has ended by itself or on command.
    Stopped,
    /// The script or its engine has failed and was stopped.
    Failed {
        /// The failure and its place.
        reason: String,
    },
}

/// The state of the script that drives the robot (report section 5.2).
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub enum Agent {
    /// There is no script.
    #[default]
    Off,
    /// Its engine is starting.
    Starting,
    /// It is called in every tick.
    Online {
        /// Duration of the last call.
        took: Duration,
    },
    /// The simulation waits for it.
    Waiting {
        /// Duration of the wait so far.
        since: Duration,
    },
    /// An error has stopped it.
    Failed,
}

impl Agent {
    /// True while a script drives the robot.
    pub const fn is_on(&self) -> bool {
        matches!(
            self,
            Self::Starting | Self::Online { .. } | Self::Waiting { .. }
        )
    }
}

/// A block on the simulation: while it is set, something outside is not ready and no part of a tick runs.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct SimBlocked(pub bool);

impl SimBlocked {
    /// Run condition: the simulation waits for nothing.
    pub fn is_clear(blocked: Res<Self>) -> bool {
        !blocked.0
    }
}
