//! The engine as effort sees it.

use bevy_rapier3d::rapier::prelude::{
    ColliderSet, DefaultBroadPhase, ImpulseJointSet, IntegrationParameters, IslandManager,
    NarrowPhase, RigidBody, RigidBodySet,
};

/// What effort depends on, and where it is set.
pub struct Engine<'a> {
    /// What holds for all bodies.
    pub parameters: &'a mut IntegrationParameters,
    /// Which bodies are awake.
    pub islands: &'a IslandManager,
    /// Which shapes are near each other.
    pub broad_phase: &'a DefaultBroadPhase,
    /// Which shapes touch each other.
    pub narrow_phase: &'a NarrowPhase,
    /// The bodies.
    pub bodies: &'a mut RigidBodySet,
    /// Their shapes.
    pub colliders: &'a ColliderSet,
    /// What holds them together.
    pub joints: &'a ImpulseJointSet,
    /// Downward acceleration in units/s².
    pub gravity: f32,
}

impl Engine<'_> {
    /// An upper bound of the speed, in units/s, that a point of a body has at the end of a tick in which nothing stops it.
    pub(crate) fn fastest_point(&self, body: &RigidBody) -> f32 {
        const REACH: f32 = 2.0;
        let falling = self.gravity * self.parameters.dt;
        body.linvel().length() + falling + REACH * body.angvel().length()
    }
}
