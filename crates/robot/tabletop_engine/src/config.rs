//! The configuration of an engine, and its faults before an engine looks at it.

use std::{
    env,
    path::{Path, PathBuf, absolute},
    sync::Arc,
    time::Duration,
};

use crate::{
    console::ConsoleLimit, discovery::locator::FoundEngine, error::EngineError, kind::EngineKind,
    octave::script_folder, private_folder::PrivateFolder,
};

/// The way in which an engine learns of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// By a line on its standard input. Fast; not possible with MATLAB everywhere.
    Stdin,
    /// By a file that it looks at again and again. Not for Python and users' drivers.
    Poll,
}

/// The time limits of an engine, which is ended after them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timeouts {
    /// For its start.
    pub start: Duration,
    /// For the init script.
    pub init: Duration,
    /// For a call of the callback script.
    pub step: Duration,
}

impl Default for Timeouts {
    fn default() -> Self {
        Self {
            start: Duration::from_secs(120),
            init: Duration::from_secs(120),
            step: Duration::from_secs(30),
        }
    }
}

/// The configuration with which an engine starts.
#[derive(Clone, Debug)]
pub struct EngineConfig {
    /// The engine.
    pub engine: FoundEngine,
    /// The way in which it learns of requests.
    pub trigger: Trigger,
    /// The folder that holds agentBehavior.m and the scripts that it names (MATLAB, Octave), or the file with the functions
    /// `init` and `callback` (Python), or the script of a user's driver. A relative path is one from the working directory.
    pub agent: PathBuf,
    /// The names of an init and a callback script to run instead of those that agentBehavior.m names.
    pub pair: Option<[String; 2]>,
    /// The directory in which the engine runs.
    pub working_dir: PathBuf,
    /// The time limits.
    pub timeouts: Timeouts,
    /// True if there is a display that figures can appear on.
    pub display: bool,
    /// The limit on the kept output of the script.
    pub console_limit: ConsoleLimit,
    /// The agent's folder if its files come from the program; it goes with the last of those that need it.
    written: Option<Arc<PrivateFolder>>,
}

impl EngineConfig {
    /// The usual: scripts of the folder "matlab" (or the file "python/example.py") in the current directory.
    pub fn new(engine: FoundEngine) -> Self {
        let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
        let unix = cfg!(unix) && !cfg!(target_os = "macos");
        Self {
            trigger: match engine.kind {
                EngineKind::Matlab => Trigger::Poll,
                EngineKind::Octave | EngineKind::Python | EngineKind::Driver => Trigger::Stdin,
            },
            agent: match engine.kind {
                EngineKind::Python => "python/example.py".into(),
                EngineKind::Driver => PathBuf::new(),
                EngineKind::Matlab | EngineKind::Octave => "matlab".into(),
            },
            engine,
            pair: None,
            working_dir: ".".into(),
            timeouts: Timeouts::default(),
            display: !unix || set("DISPLAY") || set("WAYLAND_DISPLAY"),
            console_limit: ConsoleLimit::default(),
            written: None,
        }
    }

    /// Takes an agent of which nothing is on disk: its files, by their paths, are written to a folder that is there as long as the
    /// engine is. `agent` is the path of one of them, or of a folder.
    ///
    /// # Errors
    /// They cannot be written anywhere.
    pub fn write_agent<'a>(
        &mut self,
        agent: &Path,
        files: impl IntoIterator<Item = (&'a str, &'a str)> + Clone,
    ) -> Result<(), EngineError> {
        let folder = PrivateFolder::filled(|folder| {
            let mut files = files.clone().into_iter();
            files.try_for_each(|(path, text)| folder.write(path, text.as_bytes()))
        })?;
        self.agent = folder.path().join(agent);
        self.written = Some(Arc::new(folder));
        Ok(())
    }

    /// True if the agent goes with the engine.
    pub(crate) fn is_agent_temporary(&self) -> bool {
        self.written.is_some()
    }

    /// The full path of the scripts.
    pub(crate) fn agent_path(&self) -> PathBuf {
        let agent = self.working_dir.join(&self.agent);
        absolute(&agent).unwrap_or(agent)
    }

    /// The reason why the scripts cannot be run, as far as it is known without the engine.
    pub fn fault(&self) -> Option<String> {
        let kind = self.engine.kind;
        if self.agent.as_os_str().is_empty() {
            return Some(match kind {
                EngineKind::Matlab | EngineKind::Octave => {
                    "the name of the scripts' folder is empty".to_owned()
                }
                EngineKind::Python => "the name of the Python file is empty".to_owned(),
                EngineKind::Driver => "the name of the script is empty".to_owned(),
            });
        }
        let agent = self.agent_path();
        match kind {
            EngineKind::Matlab | EngineKind::Octave => {
                script_folder::fault(&agent, self.pair.as_ref(), &self.working_dir)
            }
            _ if !agent.exists() => Some(format!("there is no {}", agent.display())),
            EngineKind::Python if agent.is_dir() => Some(format!(
                "{} is a folder; name the Python file in it",
                agent.display()
            )),
            EngineKind::Python | EngineKind::Driver => None,
        }
    }
}
