//! What is around the table in the window.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// What the user sees around and on the table; the robot's eyes see none of it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[reflect(Resource)]
pub enum Ambience {
    /// The floor of a room, and below each object its shadow, which tells its height, as long as such pictures are quick.
    #[default]
    Room,
    /// The same, however slow: the user has asked for it.
    ChosenRoom,
    /// Black, as in the original program.
    Plain,
}

impl Ambience {
    /// True if there is a room.
    pub const fn is_room(self) -> bool {
        match self {
            Self::Room | Self::ChosenRoom => true,
            Self::Plain => false,
        }
    }

    /// The other one, which the user chooses.
    pub const fn other(self) -> Self {
        match self {
            Self::Room | Self::ChosenRoom => Self::Plain,
            Self::Plain => Self::ChosenRoom,
        }
    }
}
