//! Commands to the robot.

pub(crate) mod joint_targets;
pub(crate) mod obey;
pub(crate) mod visibility;
