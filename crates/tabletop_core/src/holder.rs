//! Who holds an object.

use bevy::prelude::*;

use crate::{Hand, LimbName};

/// Who holds an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
pub enum Holder {
    /// One of the demonstrator's hands.
    Hand(Hand),
    /// The gripper of one of the robot's arms.
    Gripper(LimbName),
}

/// Marks an object that a hand or a gripper holds: it stays when the table is cleared.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub struct Held {
    /// Who holds it.
    pub by: Holder,
}
