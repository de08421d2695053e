//! Commands to the clock.

use serde::{Deserialize, Serialize};

/// A command to the clock. Core itself carries it out, before anything else of the tick sees whether it is paused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ClockCommand {
    /// Stop the clock, or let it run on.
    SetPaused(bool),
}
