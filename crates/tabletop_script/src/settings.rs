//! What can be chosen about scripts.

use std::{path::PathBuf, time::Duration};

use bevy::prelude::*;
use tabletop_core::TICKS_PER_SECOND;
use tabletop_engine::{EngineChoice, Surroundings, Timeouts};

/// Which scripts run in which engine, and how.
#[derive(Resource, Clone, Debug)]
pub struct ScriptSettings {
    /// The engine.
    pub engine: EngineChoice,
    /// The folder of `agentBehavior.m` and the scripts that it names, or the Python file; `None` for `matlab` or
    /// `python/example.py` in the working directory.
    pub agent: Option<PathBuf>,
    /// The names of an init and a callback script to run instead of those that `agentBehavior.m` names.
    pub pair: Option<[String; 2]>,
    /// Ticks from one picture of the head camera to the next; 15 are the four a second of the original program.
    pub ticks_per_picture: u64,
    /// Let scripts know of the objects, the contacts and what the grippers hold.
    pub objects: bool,
    /// Let scripts know where points of the arms are (`sensor.trackerLoc`).
    pub trackers: bool,
    /// How long to wait for the engine before it is ended.
    pub timeouts: Timeouts,
    /// How the simulation waits for the script.
    pub waiting: Waiting,
    /// Where engines are looked for.
    pub surroundings: Surroundings,
}

/// How the simulation waits for the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiting {
    /// It does nothing else meanwhile: for programs without a window, whose runs are the same every time.
    Blocking,
    /// A frame waits no longer than this; then it is drawn without a tick having passed, and so on.
    Frame(Duration),
}

impl Default for ScriptSettings {
    fn default() -> Self {
        Self {
            engine: EngineChoice::Auto,
            agent: None,
            pair: None,
            ticks_per_picture: u64::from(TICKS_PER_SECOND / 4),
            objects: true,
            trackers: true,
            timeouts: Timeouts::default(),
            waiting: Waiting::Blocking,
            surroundings: Surroundings::system(),
        }
    }
}
