//! Toggle switches.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use tabletop_geometry::Rgb;

/// A toggle switch. Its origin is the bottom edge at which its two blocks meet, along Y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct ToggleSwitch {
    /// Extents of both blocks together, in units.
    pub span: Vec3,
    /// The angle between the blocks, in degrees.
    pub angle: f32,
    /// Its colour.
    pub color: Rgb,
    /// The side that is down.
    pub pressed: Side,
    /// Number of states; each press leads to the next, and from the last to the first.
    pub states: u32,
}

/// A side of a toggle switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Reflect)]
pub enum Side {
    /// Towards -X.
    Left,
    /// Towards +X.
    Right,
}

impl Side {
    /// The opposite side.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}
