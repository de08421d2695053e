//! The recordings that a world has made.

use std::path::PathBuf;

/// The recordings that a world has made so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordingReport {
    /// Number of recordings that were started.
    pub started: usize,
    /// The earlier recordings that were in the way of these.
    pub moved_aside: Vec<MovedAside>,
    /// The fault that ended the last recording that has failed, and the remedy.
    pub failure: Option<String>,
}

/// An earlier recording that was in the way of another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MovedAside {
    /// The folder that it was in.
    pub from: PathBuf,
    /// The folder that it is in now.
    pub to: PathBuf,
}
