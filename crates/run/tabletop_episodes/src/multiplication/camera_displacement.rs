//! Cameras that stand elsewhere than usual.

use bevy::math::{Quat, Vec3};
use tabletop_core::Random;
use tabletop_geometry::{Pose, turn_about};

/// Angle by which a camera is turned per unit of its displacement, in rad.
const TURN: f32 = 0.035;

/// How far a camera is from its usual place, in units, and how it is turned, about the table's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraDisplacement {
    by: Vec3,
    turn: Quat,
}

impl CameraDisplacement {
    /// One at random: by at most so many units, and 2° per unit, along and about each axis.
    pub(super) fn any(most: f32, random: &mut Random) -> Self {
        let mut any = |most: f32| random.between((-most, most));
        let by = Vec3::new(any(most), any(most), any(most));
        let turns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turn_about(axis, any(most * TURN)));
        let turn = turns[0] * turns[1] * turns[2];
        Self { by, turn }
    }

    /// The pose of a camera that is usually at this one.
    pub fn of(self, usual: Pose) -> Pose {
        let rotation = (self.turn * usual.rotation).normalize();
        Pose::new(usual.location + self.by, rotation)
    }
}
