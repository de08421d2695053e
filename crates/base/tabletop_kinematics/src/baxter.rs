//! The robot of the report, embedded.

use crate::{ModelError, RobotModel};

/// Baxter as it is built, with the simulator's grippers; the file is `assets/baxter/baxter.urdf`.
///
/// Names: joints `left_s0` to `left_w2`, `head_pan`, `l_gripper_l_finger_joint`; frames `left_wrist`, `left_gripper`,
/// `left_end_effector`; the right arm's likewise.
///
/// # Errors
///
/// Never: a test reads it.
pub fn baxter() -> Result<RobotModel, ModelError> {
    RobotModel::from_urdf(include_str!("../../../../assets/baxter/baxter.urdf"))
}

/// Baxter as the report's simulator computed it, for comparison with its numbers: the origin of each arm has two of its
/// coordinates swapped, and the yaw of the arms' mounts is 0.7845 instead of 0.7854 rad.
///
/// # Errors
///
/// Never: a test reads it.
pub fn baxter_smile() -> Result<RobotModel, ModelError> {
    RobotModel::from_urdf(include_str!("../../../../assets/baxter/baxter_smile.urdf"))
}
