//! Bodies in an impact.

use bevy::math::{DMat3, DVec3};

/// A body in an impact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Striker {
    /// 1/kg.
    pub inverse_mass: f64,
    /// 1/(kg units²), in the axes of the world.
    pub inverse_inertia: DMat3,
    pub velocity: Velocity,
}

/// A velocity of a body's centre of mass, in units/s, and its angular velocity, in rad/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Velocity {
    pub linear: DVec3,
    pub angular: DVec3,
}
