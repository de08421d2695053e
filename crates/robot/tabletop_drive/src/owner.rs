//! Owners of solids that the robot's may meet.

use bevy::prelude::*;
use tabletop_physics::limits::GIVE;

/// The owner of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// An object or the table.
    Thing(Entity),
    /// A body of the robot, by its number.
    Body(usize),
}

impl Owner {
    /// Depth to which its solids may enter their support, in units: an object in a gripper gives way between the fingers.
    pub const fn give(self) -> f32 {
        match self {
            Self::Thing(_) => GIVE,
            Self::Body(_) => 0.0,
        }
    }
}
