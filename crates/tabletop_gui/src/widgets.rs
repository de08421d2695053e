//! The widgets of the panels.

pub(crate) mod button;
pub(crate) mod clipboard;
pub(crate) mod focus;
pub(crate) mod icon;
pub(crate) mod name;
pub(crate) mod number;
pub(crate) mod slider;
pub(crate) mod style;
