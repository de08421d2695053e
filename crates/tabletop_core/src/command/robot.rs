//! Commands to the robot.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Drive, Face, JointName, LimbName, Pose};

/// A command to the robot. Showing it and its [markers](crate::Markers) are two of them: both stay when a scene is cleared,
/// and only the robot's crate knows what they need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RobotCommand {
    /// Put the robot to the table, or take it away.
    Show(bool),
    /// Move joints of the robot; of two orders for a joint in a tick the later one counts.
    Drive(Vec<(JointName, Drive)>),
    /// Bring an end effector to a pose at the speed of manual control.
    ReachTo {
        /// The limb.
        arm: LimbName,
        /// Where [the end effector](crate::LimbState::end_effector) is to be, in the table's frame.
        pose: Pose,
    },
    /// Show this face on the robot's screen.
    ShowFace(Face),
    /// Show these points, in the table's frame, instead of those shown before.
    ShowMarkers(Vec<Vec3>),
}

impl RobotCommand {
    /// Move these joints.
    pub fn drive<J: Into<JointName>>(drives: impl IntoIterator<Item = (J, Drive)>) -> Self {
        let drives = drives.into_iter();
        Self::Drive(drives.map(|(joint, drive)| (joint.into(), drive)).collect())
    }
}
