//! Commands to the clock.

use serde::{Deserialize, Serialize};

/// A command to the clock. Core carries it out itself, before any other system of the tick asks for the pause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ClockCommand {
    /// Pause the clock, or resume it.
    SetPaused(bool),
}
