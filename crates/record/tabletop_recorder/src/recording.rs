//! Making recordings.

pub(crate) mod earlier_commands;
pub(crate) mod episode;
pub(crate) mod finish;
pub(crate) mod objects;
pub(crate) mod progress;
pub(crate) mod recorder;
pub(crate) mod recorder_plugin;
pub(crate) mod released;
pub(crate) mod report;
pub(crate) mod stage;
pub(crate) mod timeline_mark;
pub(crate) mod tracked;
pub(crate) mod unrecorded;
