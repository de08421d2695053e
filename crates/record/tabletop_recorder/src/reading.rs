//! Reading recordings.

pub(crate) mod event;
mod extent;
mod fault;
pub(crate) mod object_change;
pub(crate) mod original;
pub(crate) mod picture;
pub(crate) mod recording_reader;
pub(crate) mod rows;
pub(crate) mod segment;
