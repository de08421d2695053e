//! Settings of scripts.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
    time::Duration,
};

use bevy::prelude::*;
use tabletop_core::{ScriptEvent, ShippedFiles, TICKS_PER_SECOND};
use tabletop_engine::{
    ConsoleLimit, EngineChoice, EngineConfig, EngineError, EngineLocator, Timeouts,
};

use crate::mentions::mention;

/// The scripts, their engine, and the settings of both.
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
    /// The policy for the objects, the contacts and the held objects (`sensor.objects`, `contacts` and `held`).
    pub objects: FieldPolicy,
    /// The policy for the points on the arms (`sensor.trackerLoc`). They cost Octave half a millisecond a tick.
    pub trackers: FieldPolicy,
    /// The time limits after which the engine is ended.
    pub timeouts: Timeouts,
    /// The way in which the simulation waits for the script.
    pub waiting: Waiting,
    /// The places in which engines are looked for.
    pub locator: EngineLocator,
    /// Agents of which nothing is on disk are taken from these files.
    pub shipped: ShippedFiles,
    /// Is called with each event of the script at once, also in the middle of a tick that waits for the script.
    pub on_event: Option<fn(&ScriptEvent)>,
}

/// The policy for fields of `sensor` that cost time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldPolicy {
    /// If its name is in a script: an `.m` file in the agent's folder, or a `.py` file beside the agent's, or one up to three
    /// folders below. The files are read whenever the agent starts.
    #[default]
    Auto,
    /// Always, as scripts need that take the names from elsewhere.
    Always,
    /// Never.
    Never,
}

impl FieldPolicy {
    /// True if this agent gets the fields of these names.
    pub(crate) fn holds_for(self, agent: &Path, names: &[&str]) -> bool {
        match self {
            Self::Auto => mention(agent, names),
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// The way in which the simulation waits for the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiting {
    /// It does nothing else meanwhile: for programs without a window, whose runs are the same every time.
    Blocking,
    /// A frame waits no longer than this; then it is drawn without a tick having passed, and so on.
    Frame(Duration),
}

impl ScriptSettings {
    /// The configuration with which the engine starts.
    ///
    /// # Errors
    /// The engine that is wanted is not there, or scripts from the program cannot be written anywhere.
    pub fn engine_config(&self) -> Result<EngineConfig, EngineError> {
        let engine = self.locator.find(&self.engine)?;
        let mut config = EngineConfig::new(engine);
        if let Some(agent) = &self.agent {
            config.agent.clone_from(agent);
        }
        if let Some(agent) = self.shipped.resolve(&config.agent)
            && let Some(folder) = agent.iter().next().and_then(OsStr::to_str)
        {
            let files = self.shipped.in_folder(folder);
            let files: Vec<_> = files.map(|file| (file.path, file.text)).collect();
            config.write_agent(&agent, files)?;
        }
        config.pair.clone_from(&self.pair);
        config.timeouts = self.timeouts;
        if self.waiting == Waiting::Blocking {
            config.console_limit = ConsoleLimit::Whole;
        }
        Ok(config)
    }
}

impl Default for ScriptSettings {
    fn default() -> Self {
        Self {
            engine: EngineChoice::Auto,
            agent: None,
            pair: None,
            ticks_per_picture: u64::from(TICKS_PER_SECOND / 4),
            objects: FieldPolicy::Auto,
            trackers: FieldPolicy::Auto,
            timeouts: Timeouts::default(),
            waiting: Waiting::Blocking,
            locator: EngineLocator::system(),
            shipped: ShippedFiles::default(),
            on_event: None,
        }
    }
}
