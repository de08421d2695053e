//! Commands to the clock.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{IssuedCommand, Paused};

/// A command to the clock. Core itself carries it out, before anything else of the tick sees whether it is paused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ClockCommand {
    /// Stop the clock, or let it run on.
    SetPaused(bool),
}

pub(crate) fn carry_out(mut commands: MessageReader<IssuedCommand>, mut paused: ResMut<Paused>) {
    for (_, command) in commands.read().filter_map(IssuedCommand::of_kind) {
        match command {
            ClockCommand::SetPaused(pause) => paused.0 = *pause,
        }
    }
}
