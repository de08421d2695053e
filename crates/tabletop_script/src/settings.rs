//! What can be chosen about scripts.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
    time::Duration,
};

use bevy::prelude::*;
use tabletop_core::{AgentNews, ShippedFiles, TICKS_PER_SECOND};
use tabletop_engine::{EngineChoice, EngineConfig, EngineError, Output, Surroundings, Timeouts};

use crate::mentions::mention;

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
    /// Let scripts know of the objects, the contacts and what the grippers hold (`sensor.objects`, `contacts` and `held`).
    pub objects: Tell,
    /// Let scripts know where points of the arms are (`sensor.trackerLoc`). It costs Octave half a millisecond a tick.
    pub trackers: Tell,
    /// How long to wait for the engine before it is ended.
    pub timeouts: Timeouts,
    /// How the simulation waits for the script.
    pub waiting: Waiting,
    /// Where engines are looked for.
    pub surroundings: Surroundings,
    /// Agents of which nothing is on disk are taken from these files.
    pub shipped: ShippedFiles,
    /// Gets the script's news as they come, also in the middle of a tick that waits for the script.
    pub overhear: Option<fn(&AgentNews)>,
}

/// Whether scripts are told something that costs time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tell {
    /// If its name is in a script: an `.m` file in the agent's folder, or a `.py` file beside the agent's, or one up to three
    /// folders below. The files are read whenever the agent starts.
    #[default]
    Auto,
    /// Always, as scripts need that take the names from elsewhere.
    Always,
    /// Never.
    Never,
}

impl Tell {
    /// Whether this agent is told what has these names.
    pub(crate) fn holds_for(self, agent: &Path, names: &[&str]) -> bool {
        match self {
            Self::Auto => mention(agent, names),
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// How the simulation waits for the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiting {
    /// It does nothing else meanwhile: for programs without a window, whose runs are the same every time.
    Blocking,
    /// A frame waits no longer than this; then it is drawn without a tick having passed, and so on.
    Frame(Duration),
}

impl ScriptSettings {
    /// What the engine is started with.
    ///
    /// # Errors
    /// The engine that is wanted is not there, or scripts from the program cannot be written anywhere.
    pub fn engine_config(&self) -> Result<EngineConfig, EngineError> {
        let engine = self.surroundings.find(&self.engine)?;
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
            config.output = Output::Whole;
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
            objects: Tell::Auto,
            trackers: Tell::Auto,
            timeouts: Timeouts::default(),
            waiting: Waiting::Blocking,
            surroundings: Surroundings::system(),
            shipped: ShippedFiles::default(),
            overhear: None,
        }
    }
}
