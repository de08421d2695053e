//! Commands to the scene.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, Serializer};

use crate::{ObjectEdit, Preset, SceneSpec};

/// A command to the scene: it puts objects on the table and takes them away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneCommand {
    /// Read this task file and [set its scene](Self::Set). In [`SimSystems::Load`](crate::SimSystems::Load) it becomes that
    /// command, so a recording holds the file's content.
    Load(#[serde(serialize_with = "as_text")] PathBuf),
    /// Clear the table and put this scene on it.
    Set(Box<SceneSpec>),
    /// Remove every object from the table that no hand holds.
    Clear,
    /// Make objects without touching those on the table.
    Make {
        /// The objects to make.
        preset: Preset,
        /// The seed of their colours and place: the same seed makes the same objects in the same world.
        seed: u64,
    },
    /// Change objects on the table: all of it in turn, or nothing if some of it cannot be done.
    Edit(Vec<ObjectEdit>),
}

/// Recordings are text: bytes of a path that are no Unicode are replaced there.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}
