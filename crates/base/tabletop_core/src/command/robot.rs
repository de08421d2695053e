//! Commands to the robot.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::{Drive, Face, JointName, LimbName, MeasuredJoint};

/// A command to the robot. Showing the robot and its [markers](crate::Markers) are commands too: both stay when a scene is cleared,
/// and only the robot's crate knows what they need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RobotCommand {
    /// Put the robot at the table, or take it away.
    Show(bool),
    /// Move joints of the robot. Of two drives for one joint in a tick, the later counts.
    Drive(Vec<(JointName, Drive)>),
    /// Be where these joints of a real robot were measured, whatever is in the way, and hold what its grippers say that they hold. It takes
    /// the place of all drives of this tick and of earlier ones; joints that are missing stand still. It is no order: nothing moves a real
    /// robot because of it.
    Mirror(Vec<(JointName, MeasuredJoint)>),
    /// Bring an end effector to a pose at the speed of manual control.
    ReachTo {
        /// Limb of the end effector.
        arm: LimbName,
        /// Target of [the end effector](crate::LimbState::end_effector), in the table's frame.
        pose: Pose,
    },
    /// Show this face on the robot's screen.
    ShowFace(Face),
    /// Show these points, in the table's frame, instead of those shown before.
    ShowMarkers(Vec<Vec3>),
}

impl RobotCommand {
    /// A command that moves these joints.
    pub fn drive<J: Into<JointName>>(drives: impl IntoIterator<Item = (J, Drive)>) -> Self {
        let drives = drives.into_iter();
        Self::Drive(drives.map(|(joint, drive)| (joint.into(), drive)).collect())
    }
}
