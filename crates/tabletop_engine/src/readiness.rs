//! Whether there are scripts to run, before an engine looks at them.

use std::path::{PathBuf, absolute};

use crate::{choice::EngineKind, engine::EngineConfig, scripts};

impl EngineConfig {
    /// Where the scripts are, as a full path.
    pub(crate) fn agent_path(&self) -> PathBuf {
        let agent = self.working_dir.join(&self.agent);
        absolute(&agent).unwrap_or(agent)
    }

    /// Why the scripts cannot be run, as far as that can be seen without the engine.
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
                scripts::fault(&agent, self.pair.is_none(), &self.working_dir)
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
