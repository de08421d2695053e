//! The widgets of the panels.

pub(crate) mod button;
pub(crate) mod focus;
pub(crate) mod icon;
pub(crate) mod name;
pub(crate) mod number;
pub(crate) mod slider;
pub(crate) mod style;
pub(crate) mod typed_number;
