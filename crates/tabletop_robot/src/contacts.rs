//! What the robot touches.

pub(crate) mod contact;
pub(crate) mod sense;
