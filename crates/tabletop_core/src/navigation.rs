//! How the user moves his camera (report section 3).

use bevy::prelude::*;

/// How the camera is steered at the moment: speeds along and about its own directions. Panels set it while something in them is
/// held down.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource)]
pub struct Steering {
    /// Along the direction of view, in units/s.
    pub forward: f32,
    /// To the right, in units/s.
    pub right: f32,
    /// Along the world's Z, in units/s.
    pub up: f32,
    /// Turn left about the world's Z, in rad/s.
    pub turn_left: f32,
    /// Turn up about the camera's side axis, in rad/s.
    pub turn_up: f32,
}

/// A motion of the camera, at once. It stays upright, within reach of the table, and does not sink below the table's top.
#[derive(Message, Clone, Copy, Debug, PartialEq)]
pub enum CameraMotion {
    /// Around a point, which it sees in the same place afterwards.
    Orbit {
        /// The point, in units.
        center: Vec3,
        /// How far about the vertical line through it, in radians, counter-clockwise as seen from above.
        angle: f32,
        /// How far up above it, in radians.
        rise: f32,
    },
    /// By so many units, looking the same way.
    Shift(Vec3),
    /// Towards a point, which it sees in the same place afterwards, or away from it.
    Approach {
        /// The point, in units.
        point: Vec3,
        /// What the distance is multiplied by.
        factor: f32,
    },
    /// To one of the views.
    Look(CameraView),
}

/// Where the camera can be put at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraView {
    /// Where it was when the first table appeared, for the table that is there now.
    Start,
    /// Above the table, looking down on all of it.
    Top,
    /// Before the table's near edge, looking level.
    Front,
    /// Where the robot's head camera is, looking as it does.
    RobotEye,
    /// Looking as before, with what the selected hand holds in the middle; the table's centre if it holds nothing.
    Center,
}

impl CameraView {
    /// The views, in the order of their buttons.
    pub const ALL: [Self; 5] = [
        Self::Start,
        Self::Top,
        Self::Front,
        Self::RobotEye,
        Self::Center,
    ];
}
