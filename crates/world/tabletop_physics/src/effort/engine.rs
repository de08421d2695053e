//! The engine, as far as effort depends on it.

use bevy_rapier3d::rapier::prelude::{
    ColliderSet, DefaultBroadPhase, ImpulseJointSet, IntegrationParameters, IslandManager,
    NarrowPhase, RigidBody, RigidBodySet,
};

/// Distance, in units, of a body's outermost points from its middle, at most, as far as it matters for its turns.
pub(crate) const REACH: f32 = 2.0;

/// The parts of the engine on which effort depends, and its settings.
pub struct Engine<'a> {
    /// Settings of all bodies.
    pub parameters: &'a mut IntegrationParameters,
    /// The awake bodies.
    pub islands: &'a mut IslandManager,
    /// Pairs of shapes near each other.
    pub broad_phase: &'a DefaultBroadPhase,
    /// Pairs of shapes that touch.
    pub narrow_phase: &'a NarrowPhase,
    /// The bodies.
    pub bodies: &'a mut RigidBodySet,
    /// Their shapes.
    pub colliders: &'a ColliderSet,
    /// The joints.
    pub joints: &'a ImpulseJointSet,
    /// Downward acceleration in units/s².
    pub gravity: f32,
}

impl Engine<'_> {
    /// An upper bound on the speed, in units/s, of a body at the end of a tick in which nothing stops it.
    pub(crate) fn speed_of_fall(&self, body: &RigidBody) -> f32 {
        body.linvel().length() + self.gravity * self.parameters.dt
    }

    /// The same of any of its points.
    pub(crate) fn fastest_point(&self, body: &RigidBody) -> f32 {
        self.speed_of_fall(body) + REACH * body.angvel().length()
    }
}
