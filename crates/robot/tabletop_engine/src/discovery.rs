//! Discovery of engines, and the choice among them.

pub(crate) mod choice;
pub(crate) mod locator;
pub(crate) mod platform;
