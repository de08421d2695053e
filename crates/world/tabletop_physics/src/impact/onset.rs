//! Velocities before a step.

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{RapierContextSimulation, RapierRigidBodySet},
    rapier::prelude::{RigidBody, RigidBodyHandle},
};

use super::striker::Velocity;

/// The velocities of the awake bodies that forces move, at the beginning of the step, in the order of their handles.
#[derive(Resource, Default)]
pub(crate) struct Onset(pub(super) Vec<(RigidBodyHandle, Velocity)>);

/// Notes the velocities before a step.
pub(crate) fn note_onset(
    contexts: Query<(&RapierContextSimulation, &RapierRigidBodySet)>,
    mut onset: ResMut<Onset>,
) {
    onset.0.clear();
    for (simulation, bodies) in &contexts {
        let awake = simulation.islands.active_bodies();
        let awake = awake.filter_map(|handle| Some((handle, bodies.bodies.get(handle)?)));
        let moved = awake.filter(|(_, body)| body.is_dynamic());
        let moved = moved.map(|(handle, body)| (handle, Velocity::of(body)));
        onset.0.extend(moved);
    }
    // Rapier's own order depends on undone segments.
    onset
        .0
        .sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
}

impl Velocity {
    pub(super) fn of(body: &RigidBody) -> Self {
        Self {
            linear: body.linvel().as_dvec3(),
            angular: body.angvel().as_dvec3(),
        }
    }
}
