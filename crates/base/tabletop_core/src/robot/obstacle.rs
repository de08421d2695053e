//! Obstacles that stop an arm.

use std::fmt;

use bevy::prelude::*;
use serde::Serialize;

/// An obstacle: something that an arm can neither pass nor push away.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Reflect)]
pub enum Obstacle {
    /// The object of this id.
    Object(String),
    /// The table.
    Table,
    /// A body of the robot: a link by its name in the robot's description, or a finger.
    Link(String),
}

impl fmt::Display for Obstacle {
    /// Writes the object's id, `table`, or the link's name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Object(id) => id,
            Self::Table => "table",
            Self::Link(name) => name,
        })
    }
}
