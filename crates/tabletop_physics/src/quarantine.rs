//! Quarantine: bodies whose poses or velocities were no numbers after a step, as happens with extreme masses.
//!
//! The engine disables them, at rest where they were last, for good. Here they come back after a step without them, in which it has forgotten
//! their contacts.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::prelude::RigidBodyHandle};

/// The bodies that the engine has disabled.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Quarantine {
    /// Those of the last step.
    arrived: Vec<RigidBodyHandle>,
    /// Those that came back after it.
    left: Vec<RigidBodyHandle>,
}

impl Quarantine {
    fn is_empty(&self) -> bool {
        self.arrived.is_empty() && self.left.is_empty()
    }

    /// True if the next step will let bodies go, or take them in again.
    pub fn changes(quarantine: Res<Self>) -> bool {
        !quarantine.is_empty()
    }
}

/// Lets out of quarantine what was there during this step, and notes what has come into it.
pub(crate) fn let_out(
    mut contexts: Query<(&RapierContextSimulation, &mut RapierRigidBodySet)>,
    mut quarantine: ResMut<Quarantine>,
    disabled: Query<(), With<RigidBodyDisabled>>,
    mut velocities: Query<&mut Velocity>,
) {
    let Ok((simulation, mut set)) = contexts.single_mut() else {
        return;
    };
    let arrived = simulation.pipeline.quarantine().bodies();
    if arrived.is_empty() && quarantine.is_empty() {
        return;
    }
    quarantine.left = std::mem::replace(&mut quarantine.arrived, arrived.to_vec());
    for &handle in &quarantine.left {
        let entity = set.rigid_body_entity(handle);
        let is_disabled = entity.is_none_or(|entity| disabled.contains(entity));
        if let Some(body) = set.bodies.get_mut(handle).filter(|_| !is_disabled) {
            body.set_enabled(true);
            body.wake_up(true);
        }
    }
    // The engine leaves these to bodies that are moved, whose poses it does not compute.
    let is_finite =
        |velocity: &Velocity| velocity.linear.is_finite() && velocity.angular.is_finite();
    for mut velocity in velocities
        .iter_mut()
        .filter(|velocity| !is_finite(velocity))
    {
        *velocity = Velocity::zero();
    }
}
