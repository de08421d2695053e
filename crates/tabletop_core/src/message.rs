//! What the simulation is told, and what it tells.
//!
//! Whoever acts (mouse, keys, panels, a scenario, a replay, a test) writes the same [`SimCommand`]s; what came of them
//! is read from [`SimFact`]s. Both are streams in one order.

use std::path::PathBuf;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::SceneSpec;

/// Something the simulation is to do in its next tick.
#[derive(Message, Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SimCommand {
    /// Read this task file and [set its scene](Self::SetScene).
    LoadTask(PathBuf),
    /// Clear the table and put this on it.
    SetScene(Box<SceneSpec>),
    /// Remove every object from the table.
    ClearTable,
    /// Stop the clock, or let it run on.
    SetPaused(bool),
}

/// Something that has happened in this tick.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum SimFact {
    /// A task file was read. Its scene is on the table in this tick, without the faulty elements.
    TaskLoaded {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, each with its place.
        faults: Vec<String>,
    },
    /// An object has appeared.
    ObjectCreated {
        /// Its id.
        id: String,
        /// Its entity.
        object: Entity,
    },
    /// An object has gone.
    ObjectDeleted {
        /// Its id.
        id: String,
    },
    /// Something could not be done as it was told.
    Refused {
        /// What and why.
        reason: String,
    },
}
