//! Playing an open recording.

use bevy::prelude::*;

use crate::SimTick;

/// How the open recording plays. Whoever replays it sets this.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Playback {
    /// The moment that the world is being brought to.
    pub goal: Option<SimTick>,
    /// Whether it begins again when it is over.
    pub loops: bool,
    /// Whether it is over, so that the user can act.
    pub is_over: bool,
}

/// What is to become of the open recording. Whoever replays it reads this.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaybackOrder {
    /// Bring the world to the end of this tick, and let it stand still or play on as before.
    GoTo(SimTick),
    /// Bring the world to the end of this tick, and let it stand still.
    StopAt(SimTick),
    /// Begin again when it is over, or do not.
    Loop(bool),
    /// Put it away, and begin with a fresh task.
    Close,
}
