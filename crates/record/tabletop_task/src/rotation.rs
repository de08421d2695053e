//! Angles and components of rotations.

use bevy::math::{Quat, Vec3};

/// The angle of the rotation from one orientation to another, in rad.
pub fn angle_between(a: Quat, b: Quat) -> f32 {
    let turn = a.inverse() * b;
    2.0 * turn.xyz().length().atan2(turn.w.abs())
}

/// The component of a rotation about an axis (swing–twist decomposition).
pub fn twist_about(rotation: Quat, axis: Vec3) -> Quat {
    let along = axis * rotation.xyz().dot(axis);
    let twist = Quat::from_xyzw(along.x, along.y, along.z, rotation.w);
    match twist.length() < 1e-6 {
        true => Quat::IDENTITY,
        false => twist.normalize(),
    }
}
