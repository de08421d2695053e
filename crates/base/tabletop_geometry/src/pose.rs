//! Poses: location and orientation.

use std::ops::Mul;

use bevy::{
    math::{DMat3, DVec3},
    prelude::*,
};
use serde::{Deserialize, Serialize};

use crate::{turn_about_x, turn_about_y, turn_about_z};

/// Units of length in a metre.
pub const UNITS_PER_METER: f64 = 10.0;

/// A rigid motion: rotate, then translate. Lengths in units of 10 cm.
///
/// `a_from_b * b_from_c == a_from_c`; `pose * point` takes a point from the body's own frame to the frame in which the pose is given.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_geometry::Pose;
///
/// let pose = Pose::from_degrees(Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 90.0));
/// assert!((pose * Vec3::X - Vec3::new(1.0, 1.0, 0.0)).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct Pose {
    /// The body's origin, in units.
    pub location: Vec3,
    /// The body's orientation, a unit quaternion.
    pub rotation: Quat,
}

impl Pose {
    /// The pose that moves nothing.
    pub const IDENTITY: Self = Self::new(Vec3::ZERO, Quat::IDENTITY);

    /// A pose from its parts.
    pub const fn new(location: Vec3, rotation: Quat) -> Self {
        Self { location, rotation }
    }

    /// A pose that only translates.
    pub const fn at(location: Vec3) -> Self {
        Self::new(location, Quat::IDENTITY)
    }

    /// A pose from a location and the angles of a task file: degrees about the fixed X, then Y, then Z axis.
    pub fn from_degrees(location: Vec3, rotation: impl Into<DVec3>) -> Self {
        Self::new(location, quat_from_degrees(rotation))
    }

    /// The pose of a camera at a point that looks at another: its -Z goes there, its X is level. Locations in units.
    pub fn looking_at(from: Vec3, at: Vec3) -> Self {
        Self::from(&Transform::from_translation(from).looking_at(at, Vec3::Z))
    }

    /// The inverse motion.
    pub fn inverse(self) -> Self {
        let rotation = self.rotation.inverse();
        Self::new(rotation * -self.location, rotation)
    }

    /// The orientation as task files and recordings write it; see [`degrees_from_quat`].
    pub fn degrees(self) -> Vec3 {
        degrees_from_quat(self.rotation)
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Mul for Pose {
    type Output = Self;

    fn mul(self, inner: Self) -> Self {
        Self::new(self * inner.location, self.rotation * inner.rotation)
    }
}

impl Mul<Vec3> for Pose {
    type Output = Vec3;

    fn mul(self, point: Vec3) -> Vec3 {
        self.rotation * point + self.location
    }
}

impl From<Pose> for Transform {
    fn from(pose: Pose) -> Self {
        Transform::from_translation(pose.location).with_rotation(pose.rotation)
    }
}

impl From<&Transform> for Pose {
    fn from(transform: &Transform) -> Self {
        Self::new(transform.translation, transform.rotation)
    }
}

/// The rotation of a task file: `degrees.x` about the fixed X axis, then `degrees.y` about Y, then `degrees.z` about Z.
pub fn quat_from_degrees(degrees: impl Into<DVec3>) -> Quat {
    let [x, y, z] = degrees.into().to_array().map(f64::to_radians);
    let rotation = turn_about_z(z) * turn_about_y(y) * turn_about_x(x);
    rotation.as_quat().normalize()
}

/// The angles, in degrees, for which [`quat_from_degrees`] gives this rotation: Y in [-90, 90], X and Z in (-180, 180].
/// Where Y is ±90 they are not unique, and X is 0.
pub fn degrees_from_quat(rotation: Quat) -> Vec3 {
    let m = DMat3::from_quat(rotation.as_dquat().normalize());
    // The third row and first column of Rz·Ry·Rx.
    let sin_y = (-m.x_axis.z).clamp(-1.0, 1.0) + 0.0;
    let (x, z) = if sin_y.abs() < 1.0 - 1e-9 {
        (
            libm::atan2(m.y_axis.z, m.z_axis.z),
            libm::atan2(m.x_axis.y, m.x_axis.x),
        )
    } else {
        (0.0, libm::atan2(-m.y_axis.x, m.y_axis.y))
    };
    let half_open = |radians: f64| {
        let degrees = radians.to_degrees() as f32;
        if degrees <= -180.0 { 180.0 } else { degrees }
    };
    Vec3::new(
        half_open(x),
        libm::asin(sin_y).to_degrees() as f32,
        half_open(z),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_turn_about_fixed_x_then_y_then_z() {
        let rotation = quat_from_degrees(Vec3::new(30.0, 40.0, 50.0));
        for (axis, expected) in [
            (Vec3::X, Vec3::new(0.4924, 0.5868, -0.6428)),
            (Vec3::Y, Vec3::new(-0.4568, 0.8029, 0.3830)),
            (Vec3::Z, Vec3::new(0.7408, 0.1050, 0.6634)),
        ] {
            assert!(
                (rotation * axis - expected).length() < 1e-4,
                "{axis} went to {}",
                rotation * axis
            );
        }
    }

    #[test]
    fn angles_come_back() {
        for degrees in [
            Vec3::new(0.0, 0.0, 45.0),
            Vec3::new(0.0, 0.0, 180.0),
            Vec3::new(-170.0, 89.0, 10.0),
            Vec3::new(0.0, 90.0, -90.0),
            Vec3::new(0.0, -90.0, 135.0),
        ] {
            let back = degrees_from_quat(quat_from_degrees(degrees));
            assert!((back - degrees).length() < 1e-3, "{degrees} became {back}");
        }
    }

    #[test]
    fn a_camera_looks_where_it_is_aimed_with_a_level_horizon() {
        let from = Vec3::new(1.0, -5.0, 4.0);
        for at in [
            Vec3::ZERO,
            Vec3::new(1.0, -5.0, 0.0),
            Vec3::new(9.0, 1.0, 7.0),
        ] {
            let pose = Pose::looking_at(from, at);
            assert!((pose.rotation * Vec3::NEG_Z - (at - from).normalize()).length() < 1e-5);
            assert!((pose.rotation * Vec3::X).z.abs() < 1e-5);
        }
    }

    #[test]
    fn a_pose_times_its_inverse_is_no_motion() {
        let pose = Pose::from_degrees(Vec3::new(1.0, -2.0, 3.0), Vec3::new(10.0, 20.0, 30.0));
        let point = pose * pose.inverse() * Vec3::new(4.0, 5.0, 6.0);
        assert!((point - Vec3::new(4.0, 5.0, 6.0)).length() < 1e-5);
    }
}
