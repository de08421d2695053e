//! What the panels are made of.

pub(crate) mod clipboard;
pub(crate) mod slider;
pub(crate) mod style;
