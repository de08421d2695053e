//! Manipulators: hands and grippers, and the objects that they hold.

use std::fmt;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Hand, LimbName};

/// A hand or a gripper.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, Reflect,
)]
#[serde(rename_all = "kebab-case")]
pub enum Manipulator {
    /// The gripper of one of the robot's arms.
    Gripper(LimbName),
    /// One of the demonstrator's hands.
    #[serde(untagged)]
    Hand(Hand),
}

/// Marks an object that a hand or a gripper holds: it stays when the table is cleared.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub struct Held {
    /// The hand or gripper.
    pub by: Manipulator,
}

impl fmt::Display for Manipulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hand(hand) => write!(f, "{hand}"),
            Self::Gripper(arm) => write!(f, "{} gripper", arm),
        }
    }
}
