//! The user's camera and its motions (report section 3).

use bevy::prelude::*;

/// Marks the camera through which the user looks. The view makes it; the panels are drawn over its picture.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct UserCamera;

/// The present steering of the camera: speeds along and about its own directions. Panels set it while one of their controls is
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

/// A motion of the camera, done at once. The camera stays upright and within reach of the table, and never sinks below the
/// table's top.
#[derive(Message, Clone, Copy, Debug, PartialEq)]
pub enum CameraMotion {
    /// Around a point, which stays in the same place of the picture.
    Orbit {
        /// The point, in units.
        center: Vec3,
        /// Angle about the vertical line through it, in radians, counterclockwise as seen from above.
        angle: f32,
        /// Angle upwards about it, in radians.
        rise: f32,
    },
    /// By this vector, in units, without turning.
    Shift(Vec3),
    /// Towards a point or away from it. The point stays in the same place of the picture.
    Approach {
        /// The point, in units.
        point: Vec3,
        /// Factor on the distance.
        factor: f32,
    },
    /// To one of the fixed views.
    Look(CameraView),
}

/// A view that the camera can take at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraView {
    /// The first view of a table, for the present table.
    Start,
    /// From above, looking down on the whole table.
    Top,
    /// From before the table's near edge, looking level.
    Front,
    /// The first view from the other side of the table: past the robot, towards the user's side.
    Across,
    /// The view of the robot's head camera.
    RobotEye,
    /// In the same direction as before, with the held object in the middle, or the table's centre if nothing is held.
    Center,
}

/// The view of the first table. Later ones leave the camera where the user has brought it.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct FirstView(pub CameraView);

impl Default for FirstView {
    fn default() -> Self {
        Self(CameraView::Start)
    }
}

impl CameraView {
    /// The views, in the order of their buttons.
    pub const ALL: [Self; 6] = [
        Self::Start,
        Self::Top,
        Self::Front,
        Self::Across,
        Self::RobotEye,
        Self::Center,
    ];
}
