//! Grippers and their grips.

pub(crate) mod alignment;
pub(crate) mod closing;
pub(crate) mod finger_pad;
pub(crate) mod grips;
