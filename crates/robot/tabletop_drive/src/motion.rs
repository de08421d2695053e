//! Motion of the joints in a tick.

pub(crate) mod advance;
mod mirror;
mod obstacle;
pub(crate) mod placement;
mod poses;
mod push;
mod sweep;
pub(crate) mod tick_motion;
pub(crate) mod view;
