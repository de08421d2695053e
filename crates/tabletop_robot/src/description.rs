//! Descriptions of robots.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_core::{LayoutError, LayoutFile, RobotLayout, is_shipped};
use tabletop_kinematics::{Geometry, ModelError, RobotModel};
use thiserror::Error;

use crate::{
    articulation::tree::Articulation,
    look::{meshes::is_ours, shared_figures::SharedFigures},
    source::DescriptionSource,
};

/// The description of the robot at the table.
#[derive(Resource, Clone, Debug)]
pub struct Description {
    /// Its model.
    pub model: RobotModel,
    /// Its limbs and joints.
    pub layout: RobotLayout,
    /// The files that it was read from; `None` for the robot that ships with the program.
    pub source: Option<DescriptionSource>,
    /// The looks of its bodies, which its clones share.
    pub(crate) figures: SharedFigures,
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
    /// It has meshes, in folders that it may not name.
    #[error(
        "the meshes of its URDF {} are outside of the recording; `--allow-path DIR` lets it name files in DIR",
        .0.display()
    )]
    Outside(PathBuf),
}

impl Description {
    /// The robot that files describe.
    ///
    /// # Errors
    ///
    /// The texts cannot be used, or the URDF lacks joints or links that the `robot.ron` names; the error names them.
    pub fn read(source: DescriptionSource) -> Result<Self, DescriptionError> {
        let model = RobotModel::from_urdf(&source.urdf)?;
        let folder = source.folder();
        let is_there = !is_shipped(&source.path) && folder.is_dir();
        if is_there && !source.reaches(folder) && names_files(&model) {
            return Err(DescriptionError::Outside(source.path));
        }
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
            figures: SharedFigures::default(),
        })
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
            figures: SharedFigures::default(),
        })
    }
}

/// Whether a robot has meshes that are not part of the program.
fn names_files(model: &RobotModel) -> bool {
    let mut shapes = model
        .links()
        .iter()
        .flat_map(|link| link.visuals.iter().chain(&link.collisions));
    shapes.any(|shape| matches!(shape.geometry, Geometry::Mesh { .. }) && !is_ours(shape))
}
