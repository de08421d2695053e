//! The windows inside the window.

pub(crate) mod bar;
pub(crate) mod demo_tools;
pub(crate) mod head_view;
pub(crate) mod messages;
pub(crate) mod pause;
pub(crate) mod robot;
pub(crate) mod status;
