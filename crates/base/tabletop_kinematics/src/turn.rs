//! Rotations that are the same on every processor. Those of glam use sine and cosine of the C library, which chooses its algorithm by the
//! processor.

use glam::{DMat3, DQuat, DVec3};

/// The rotation about an axis of length 1 by an angle in radians.
pub(crate) fn turn_about(axis: DVec3, angle: f64) -> DMat3 {
    let (sin, cos) = libm::sincos(angle);
    let DVec3 { x, y, z } = axis;
    let rest = 1.0 - cos;
    let (sin_x, sin_y, sin_z) = (x * sin, y * sin, z * sin);
    let (xy, xz, yz) = (x * y * rest, x * z * rest, y * z * rest);
    DMat3::from_cols(
        DVec3::new(x * x * rest + cos, xy + sin_z, xz - sin_y),
        DVec3::new(xy - sin_z, y * y * rest + cos, yz + sin_x),
        DVec3::new(xz + sin_y, yz - sin_x, z * z * rest + cos),
    )
}

/// The rotation about the fixed axes X, then Y, then Z, by angles in radians.
pub(crate) fn from_roll_pitch_yaw(roll: f64, pitch: f64, yaw: f64) -> DQuat {
    let half = |angle: f64| libm::sincos(angle / 2.0);
    let ((sin_x, cos_x), (sin_y, cos_y), (sin_z, cos_z)) = (half(roll), half(pitch), half(yaw));
    DQuat::from_xyzw(
        sin_x * cos_y * cos_z - cos_x * sin_y * sin_z,
        cos_x * sin_y * cos_z + sin_x * cos_y * sin_z,
        cos_x * cos_y * sin_z - sin_x * sin_y * cos_z,
        cos_x * cos_y * cos_z + sin_x * sin_y * sin_z,
    )
}

#[cfg(test)]
mod tests {
    use glam::EulerRot;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn rotations_are_those_of_glam(x in -7.0..7.0, y in -7.0..7.0, z in -7.0..7.0, angle in -7.0..7.0) {
            let axis = DVec3::new(x, y, z).normalize();
            let found = turn_about(axis, angle);
            prop_assert!(found.abs_diff_eq(DMat3::from_axis_angle(axis, angle), 1e-14));
            let found = from_roll_pitch_yaw(x, y, z);
            prop_assert!(found.abs_diff_eq(DQuat::from_euler(EulerRot::ZYX, z, y, x), 1e-14));
        }
    }
}
