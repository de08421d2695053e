//! The windows inside the window.

pub(crate) mod arrangement;
pub(crate) mod bar;
pub(crate) mod browser;
pub(crate) mod camera;
pub(crate) mod caption;
pub(crate) mod context_menu;
pub(crate) mod demo_tools;
pub(crate) mod display;
pub(crate) mod head_view;
pub(crate) mod help;
pub(crate) mod hints;
pub(crate) mod memory;
pub(crate) mod messages;
pub(crate) mod name_tag;
pub(crate) mod objects;
pub(crate) mod panel;
mod panel_order;
pub(crate) mod pause;
pub(crate) mod plots;
pub(crate) mod pose;
pub(crate) mod quit;
pub(crate) mod recording_mark;
pub(crate) mod recordings;
pub(crate) mod robot;
pub(crate) mod status;
#[cfg(test)]
mod test_click;
pub(crate) mod timeline;
pub(crate) mod toasts;
pub(crate) mod window;
pub(crate) mod window_keys;

pub use arrangement::Panels;
pub use browser::{Browser, Purpose};
pub use panel::Panel;
