//! Contacts of the robot.

pub(crate) mod contact;
pub(crate) mod sense;
