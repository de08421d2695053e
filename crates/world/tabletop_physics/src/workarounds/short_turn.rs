//! Kinematic bodies turn the short way.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::prelude as rapier};

/// Lets kinematic bodies turn by less than half a turn in a step. A quaternion and its negative are the same orientation, but Rapier takes
/// velocities from them as they stand: when the sign changes, a body that hardly moves would strike its contacts as if it spun round.
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
            let next = *body.next_position();
            turn_to(&mut bodies, handle.0, next);
        }
    }
}

/// Gives a body its next pose, with that sign of its quaternion to which it turns by less than half a turn; unless it has it already: what is
/// touched counts as changed.
pub(crate) fn turn_to(
    bodies: &mut Mut<RapierRigidBodySet>,
    handle: rapier::RigidBodyHandle,
    mut next: rapier::Pose,
) {
    let Some(body) = bodies.bodies.get(handle) else {
        return;
    };
    if body.position().rotation.dot(next.rotation) < 0.0 {
        next.rotation = -next.rotation;
    }
    if *body.next_position() != next
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
