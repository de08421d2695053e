//! Playback of an open recording.

use bevy::prelude::*;

use crate::SimTick;

/// The playback of the open recording. The replayer sets this.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Playback {
    /// The tick that the world is being brought to.
    pub goal: Option<SimTick>,
    /// True if it begins again at its end.
    pub loops: bool,
    /// True if it has ended, so that the user can act.
    pub is_over: bool,
}

/// A request to the playback of the open recording. The replayer reads it.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaybackOrder {
    /// Bring the world to the end of this tick, then stand still or play on as before.
    GoTo(SimTick),
    /// Bring the world to the end of this tick, then stand still.
    StopAt(SimTick),
    /// Begin again at its end, or do not.
    Loop(bool),
    /// Close it and begin with a fresh task.
    Close,
}
