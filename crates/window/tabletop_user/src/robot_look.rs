//! How the robot is shown in the window.

use bevy::prelude::*;

/// How the robot is shown to the user; its own eyes see it as it is.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct RobotLook {
    /// True if the user sees through it.
    pub is_translucent: bool,
}

impl RobotLook {
    /// The part of the picture behind it that a translucent robot covers, 0..=1.
    pub const OPACITY: f32 = 0.3;
}
