//! Motion of the joints in a tick.

pub(crate) mod advance;
pub(crate) mod environment;
pub(crate) mod placement;
pub(crate) mod sweep;
pub(crate) mod view;
