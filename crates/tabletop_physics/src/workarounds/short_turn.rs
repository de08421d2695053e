//! Kinematic bodies turn the short way.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::prelude as rapier};
use tabletop_core::Pose;

use crate::geometry::to_rapier;

/// Lets kinematic bodies turn by less than half a turn in a step. A quaternion and its negative are the same orientation, but Rapier takes
/// velocities from them as they stand: when the sign changes, a body that hardly moves would strike what it touches as if it spun round.
pub(crate) fn turn_the_short_way(
    moved: Query<&RapierRigidBodyHandle, Changed<GlobalTransform>>,
    mut bodies: Query<&mut RapierRigidBodySet, With<DefaultRapierContext>>,
) {
    let Ok(mut bodies) = bodies.single_mut() else {
        return;
    };
    for handle in &moved {
        let body = bodies.bodies.get(handle.0);
        if let Some(body) = body.filter(|body| body.is_kinematic()) {
            let next = the_short_way(body, *body.next_position());
            go_to(&mut bodies, handle.0, next);
        }
    }
}

/// Sends a kinematic body to a pose in the next step, by the short way. Its [`Transform`] follows after the step. False if the
/// engine has no such body.
pub fn send(bodies: &mut RapierRigidBodySet, entity: Entity, pose: Pose) -> bool {
    let Some(&handle) = bodies.entity2body().get(&entity) else {
        return false;
    };
    let body = bodies.bodies.get(handle);
    let Some(body) = body.filter(|body| body.is_kinematic() && body.is_enabled()) else {
        return false;
    };
    let next = the_short_way(body, to_rapier(pose));
    go_to(bodies, handle, next);
    true
}

/// The next pose of a body, with that sign of its quaternion to which the body turns by less than half a turn.
fn the_short_way(body: &rapier::RigidBody, mut next: rapier::Pose) -> rapier::Pose {
    if body.position().rotation.dot(next.rotation) < 0.0 {
        next.rotation = -next.rotation;
    }
    next
}

/// Gives a body its next pose, unless it has it already: what is touched counts as changed.
fn go_to(bodies: &mut RapierRigidBodySet, handle: rapier::RigidBodyHandle, next: rapier::Pose) {
    let body = bodies.bodies.get(handle);
    if body.is_some_and(|body| *body.next_position() != next)
        && let Some(body) = bodies.bodies.get_mut(handle)
    {
        body.set_next_kinematic_position(next);
    }
}

/// The turn from one orientation to another as an axis as long as its angle, in rad; less than half a turn.
pub(crate) fn short_turn(from: Quat, to: Quat) -> Vec3 {
    let turn = to * from.inverse();
    match turn.w < 0.0 {
        true => (-turn).to_scaled_axis(),
        false => turn.to_scaled_axis(),
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn the_sign_of_a_quaternion_makes_no_turn() {
        let rotation = Quat::from_rotation_z(-FRAC_PI_2);
        assert!(short_turn(rotation, -rotation).length() < 1e-3);
        let turn = short_turn(rotation, -(Quat::from_rotation_x(0.1) * rotation));
        assert!((turn - Vec3::X * 0.1).length() < 1e-3, "{turn}");
    }
}
