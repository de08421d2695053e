//! Which robot it is.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_kinematics::{ModelError, RobotModel};

use crate::articulation::tree::Articulation;

/// Which robot stands at the table.
#[derive(Resource, Clone, Debug)]
pub struct Description {
    /// Its model.
    pub model: RobotModel,
    /// Where it was read from; `None` for the robot that comes with the program.
    pub source: Option<Source>,
}

/// Where a robot's description was read from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// The file, beside which its meshes are.
    pub path: PathBuf,
    /// What it says.
    pub urdf: String,
}

impl Description {
    /// The robot that a file describes.
    ///
    /// # Errors
    ///
    /// The text is no URDF that can be used, or lacks joints or links that the robot's arms need; the error names them.
    pub fn read(source: Source) -> Result<Self, ModelError> {
        let model = RobotModel::from_urdf(&source.urdf)?;
        Articulation::new(model.clone())?;
        Ok(Self {
            model,
            source: Some(source),
        })
    }

    /// The file beside which its meshes are.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.source.as_ref().map(|source| source.path.as_path())
    }

    /// The Baxter that comes with the program.
    ///
    /// # Errors
    ///
    /// None that a test of the program would not find.
    pub fn baxter() -> Result<Self, ModelError> {
        Ok(Self {
            model: tabletop_kinematics::baxter()?,
            source: None,
        })
    }
}
