//! Grippers, and what they hold.

pub(crate) mod alignment;
pub(crate) mod closing;
pub(crate) mod finger_pad;
pub(crate) mod grips;
