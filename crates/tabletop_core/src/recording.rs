//! What is known of the present recording outside the recorder.

use std::path::PathBuf;

use bevy::prelude::*;

/// Whether a recording is running. The recorder sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Recording(pub bool);

/// Whether a recording is being replayed. Whoever replays it sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Replaying(pub bool);

/// How far the demonstration can be undone and redone. Whoever keeps the snapshots of the world sets it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct History {
    /// How many segments can be undone.
    pub undoable: usize,
    /// How many segments can be redone.
    pub redoable: usize,
    /// How many segments can no longer be undone, because there was no memory left for them.
    pub dropped: usize,
    /// The memory, in bytes, that the snapshots of the world take.
    pub bytes: usize,
    /// The most memory, in bytes, that they may take; when there is more, the oldest segment can no longer be undone.
    pub most_bytes: usize,
}

/// The window is to open the recording in this folder and to play it. Whoever replays recordings reads it.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub struct OpenRecording(pub PathBuf);
