//! Holders of objects.

use bevy::prelude::*;

use crate::{Hand, LimbName};

/// The holder of an object.
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
    /// The holder.
    pub by: Holder,
}
