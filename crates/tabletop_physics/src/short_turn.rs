//! Kinematic bodies turn the short way.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
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
        let turns_the_long_way = bodies.bodies.get(handle.0).is_some_and(|body| {
            let turns = body.position().rotation.dot(body.next_position().rotation);
            body.is_kinematic() && turns < 0.0
        });
        if turns_the_long_way && let Some(body) = bodies.bodies.get_mut(handle.0) {
            let mut next = *body.next_position();
            next.rotation = -next.rotation;
            body.set_next_kinematic_position(next);
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
    let mut next = to_rapier(pose);
    if body.position().rotation.dot(next.rotation) < 0.0 {
        next.rotation = -next.rotation;
    }
    if next != *body.next_position()
        && let Some(body) = bodies.bodies.get_mut(handle)
    {
        body.set_next_kinematic_position(next);
    }
    true
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
