//! The present recording, as parts outside the recorder know it.

use std::path::PathBuf;

use bevy::prelude::*;

/// True while a recording is running. The recorder sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Recording(pub bool);

/// True while a recording is being replayed. The replayer sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Replaying(pub bool);

/// The extent to which the demonstration can be undone and redone. The owner of the world's snapshots sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct History {
    /// Number of segments that can be undone.
    pub undoable: usize,
    /// Number of segments that can be redone.
    pub redoable: usize,
    /// Number of segments that can no longer be undone, because their memory was needed.
    pub dropped: usize,
    /// Memory of the world's snapshots, in bytes.
    pub bytes: usize,
    /// Limit on that memory, in bytes; beyond it, the oldest segment can no longer be undone.
    pub most_bytes: usize,
}

/// A request to open the recording in this folder in the window and play it. The replayer reads it.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub struct OpenRecording(pub PathBuf);
