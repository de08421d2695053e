//! Where engines are and which one is meant.

pub(crate) mod choice;
pub(crate) mod locator;
pub(crate) mod platform;
