//! Quarantine of bodies with a NaN pose or velocity after a step, as happens with extreme masses.
//!
//! Rapier disables them for good, at rest at their last finite pose. Here they come back after a step without them, in which Rapier has
//! forgotten their contacts.

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{
        RapierContextSimulation, RapierRigidBodyHandle, RapierRigidBodySet, RigidBodyDisabled,
        Velocity,
    },
    rapier::prelude::{RigidBody, RigidBodyHandle, RigidBodyType},
};

/// The bodies that Rapier has disabled.
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

/// Releases the bodies that were in quarantine during this step, notes the new ones, and stops bodies with a NaN velocity.
pub(crate) fn let_out(
    mut contexts: Query<(&RapierContextSimulation, &mut RapierRigidBodySet)>,
    mut quarantine: ResMut<Quarantine>,
    disabled: Query<(), With<RigidBodyDisabled>>,
    mut velocities: Query<(&RapierRigidBodyHandle, &mut Velocity)>,
) {
    let Ok((simulation, mut set)) = contexts.single_mut() else {
        return;
    };
    for (handle, mut velocity) in &mut velocities {
        if !(velocity.linear.is_finite() && velocity.angular.is_finite()) {
            *velocity = Velocity::zero();
            if let Some(body) = set.bodies.get_mut(handle.0) {
                stop(body);
            }
        }
    }
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
}

/// Stops a body. Rapier checks poses alone, so it keeps a NaN velocity that has not moved a body yet, and that of a kinematic body.
fn stop(body: &mut RigidBody) {
    let kind = body.body_type();
    // Otherwise only dynamic bodies could be stopped.
    body.set_body_type(RigidBodyType::Fixed, false);
    body.set_body_type(kind, false);
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce as _;
    use bevy_rapier3d::rapier::prelude::RigidBodyBuilder;

    use super::*;

    #[test]
    fn a_body_with_a_nan_velocity_is_stopped_before_it_moves() {
        for kind in [
            RigidBodyType::Dynamic,
            RigidBodyType::KinematicPositionBased,
        ] {
            let mut world = World::new();
            world.init_resource::<Quarantine>();
            let mut set = RapierRigidBodySet::default();
            let body = RigidBodyBuilder::dynamic().linvel(Vec3::NAN);
            let handle = set.bodies.insert(body);
            set.bodies[handle].set_body_type(kind, false);
            assert!(set.bodies[handle].linvel().is_nan());
            let engine = world.spawn((RapierContextSimulation::default(), set)).id();
            let velocity = Velocity::linear(Vec3::NAN);
            let body = world.spawn((RapierRigidBodyHandle(handle), velocity)).id();
            world.run_system_once(let_out).unwrap();
            assert_eq!(world.get::<Velocity>(body), Some(&Velocity::zero()));
            let set = world.get::<RapierRigidBodySet>(engine).unwrap();
            let body = &set.bodies[handle];
            assert_eq!((body.linvel(), body.body_type()), (Vec3::ZERO, kind));
        }
    }
}
