//! The script that drives the robot, as the rest of the program sees it.

use std::time::Duration;

use bevy::prelude::*;

/// What the script bridge is told. These are no commands to the simulation: a recording holds what the script has ordered, not
/// the script.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum AgentOrder {
    /// Start the script engine and the script.
    Start,
    /// Stop the script.
    Stop,
}

/// What the script bridge tells.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum AgentNews {
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
    /// The script has ended, by itself or because it was told to.
    Stopped,
    /// The script or its engine has failed, and is stopped.
    Failed {
        /// What happened, and where.
        reason: String,
    },
}

/// What the script that drives the robot is doing (report section 5.2).
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
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

/// Whether the simulation stands still because something outside of it is not ready: no part of a tick runs.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standstill(pub bool);

impl Standstill {
    /// Run condition: nothing is waited for.
    pub fn is_over(standstill: Res<Self>) -> bool {
        !standstill.0
    }
}
