//! Twists: velocities of objects.

use bevy::prelude::*;

/// The velocity of an object at the end of a tick, in the table's frame. Physics writes it.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Twist {
    /// Velocity of its centre of mass, in units/s.
    pub linear: Vec3,
    /// Angular velocity, in rad/s.
    pub angular: Vec3,
}
