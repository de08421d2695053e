//! Settings of the physics.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// Constants of the simulated world. They are read when the plugin is built and when an object appears.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[serde(default, deny_unknown_fields)]
#[reflect(Resource)]
pub struct PhysicsSettings {
    /// Downward acceleration in units/s². True gravity at this scale is 98.1.
    pub gravity: f32,
    /// Coulomb friction of every surface. The friction of a contact is the product of both surfaces'.
    pub friction: f32,
    /// Restitution of every surface, 0..=1. That of a contact is the mean of both surfaces'.
    pub restitution: f32,
    /// Rate, in 1/s, at which rotations die away. Falling is not damped.
    pub angular_damping: f32,
    /// Rate, in 1/s, at which the rotations of cylinders, spheres and rings die away: their rolling resistance.
    pub rolling_damping: f32,
    /// Rate, in 1/s, at which the rotations of chain links die away, so that a chain comes to rest.
    pub link_damping: f32,
    /// True if objects at rest are left out of the computation until something touches them.
    pub sleep: bool,
}

impl PhysicsSettings {
    /// The fault of settings that make no sense.
    pub fn fault(&self) -> Option<String> {
        let Self {
            gravity,
            friction,
            restitution,
            angular_damping,
            rolling_damping,
            link_damping,
            sleep: _,
        } = *self;
        let numbers = [
            ("gravity", gravity, -1e4..=1e4),
            ("friction", friction, 0.0..=1e3),
            ("restitution", restitution, 0.0..=1.0),
            ("angular_damping", angular_damping, 0.0..=1e4),
            ("rolling_damping", rolling_damping, 0.0..=1e4),
            ("link_damping", link_damping, 0.0..=1e4),
        ];
        let (name, value, range) = numbers
            .into_iter()
            .find(|(_, value, range)| !range.contains(value))?;
        let (least, most) = range.into_inner();
        Some(format!(
            "{name}: {value} is not a number from {least} to {most}"
        ))
    }

    /// The default settings.
    pub const DEFAULT: Self = Self {
        gravity: 98.1,
        friction: 0.5,
        restitution: 0.0,
        angular_damping: 0.5,
        rolling_damping: 2.0,
        link_damping: 12.0,
        sleep: true,
    };
}

impl Default for PhysicsSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}
