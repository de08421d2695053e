//! What the robot is commanded to do.

pub(crate) mod joint_targets;
pub(crate) mod obey;
pub(crate) mod reach;
pub(crate) mod visibility;
