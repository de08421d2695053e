//! Descriptions of robots.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_core::{LayoutError, LayoutFile, RobotLayout};
use tabletop_kinematics::{ModelError, RobotModel};
use thiserror::Error;

use crate::articulation::tree::Articulation;

/// The description of the robot at the table.
#[derive(Resource, Clone, Debug)]
pub struct Description {
    /// Its model.
    pub model: RobotModel,
    /// Its limbs and joints.
    pub layout: RobotLayout,
    /// The files that it was read from; `None` for the robot that ships with the program.
    pub source: Option<DescriptionSource>,
}

/// The files that a robot was read from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DescriptionSource {
    /// Path of the URDF, beside which its meshes are.
    pub path: PathBuf,
    /// Content of the URDF.
    pub urdf: String,
    /// Content of the `robot.ron`. Without it, limbs and joints are those of Baxter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<String>,
}

/// The error of a robot that cannot be used.
#[derive(Debug, Error)]
pub enum DescriptionError {
    /// Its URDF cannot be used, or lacks a name of the `robot.ron`.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Its `robot.ron` cannot be used.
    #[error("robot.ron: {0}")]
    Layout(#[from] LayoutError),
}

impl Description {
    /// The robot that files describe.
    ///
    /// # Errors
    ///
    /// The texts cannot be used, or the URDF lacks joints or links that the `robot.ron` names; the error names them.
    pub fn read(source: DescriptionSource) -> Result<Self, DescriptionError> {
        let model = RobotModel::from_urdf(&source.urdf)?;
        let layout = match &source.layout {
            Some(text) => LayoutFile::read(text)?.layout(|joint| {
                let joint = model.find_joint(joint).ok()?;
                Some(model.joint(joint).limits)
            })?,
            None => RobotLayout::default(),
        };
        Articulation::new(model.clone(), layout.clone())?;
        Ok(Self {
            model,
            layout,
            source: Some(source),
        })
    }

    /// The file beside which its meshes are.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.source.as_ref().map(|source| source.path.as_path())
    }

    /// The Baxter that ships with the program.
    ///
    /// # Errors
    ///
    /// None that the program's tests would not find.
    pub fn baxter() -> Result<Self, DescriptionError> {
        Ok(Self {
            model: tabletop_kinematics::baxter()?,
            layout: RobotLayout::default(),
            source: None,
        })
    }
}
