//! Commands for what is on the table.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::{Preset, SceneSpec};

/// A command to what puts objects on the table and takes them away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneCommand {
    /// Read this task file and [set its scene](Self::Set). In [`SimSystems::Load`](crate::SimSystems::Load) it becomes that
    /// command, so a recording holds what the file said.
    Load(PathBuf),
    /// Clear the table and put this on it.
    Set(Box<SceneSpec>),
    /// Remove every object from the table that no hand holds.
    Clear,
    /// Make objects, without touching any that are there.
    Make {
        /// What to make.
        preset: Preset,
        /// Decides colours and place: the same seed makes the same in the same world.
        seed: u64,
    },
}
