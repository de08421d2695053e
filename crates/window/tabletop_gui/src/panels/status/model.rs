//! The content of the Status window.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_core::{Agent, History, SimTick};

use super::speed::Means;

/// The renderer of the window. The code that opens the window sets it.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct Renderer {
    /// The name that it gives itself.
    pub name: String,
    /// True if it draws on the processor instead of a graphics card.
    pub is_software: bool,
}

/// The content of the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Model {
    pub mean: Means,
    /// True if nothing moves in the picture.
    pub is_still: bool,
    /// True if the world has been resting since the simulated time.
    pub is_resting: bool,
    /// The simulated time.
    pub tick: SimTick,
    pub is_paused: bool,
    pub agent: Agent,
    pub film: FilmState,
    pub history: History,
    pub renderer: Option<Renderer>,
}

/// The state of recordings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum FilmState {
    #[default]
    None,
    /// One is written.
    Recorded {
        folder: PathBuf,
        segment: usize,
        frame: u64,
    },
    /// One is played.
    Replayed,
}
