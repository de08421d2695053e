//! The demonstrated task, as scripts, panels and view know it.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_geometry::{Pose, Rgb};

use crate::SimTick;

/// The task that a recording demonstrates, in words. The crate that explains recordings sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct ShownTask {
    /// The recording's folder.
    pub folder: PathBuf,
    /// The steps, in the order in which they were demonstrated; empty if there is no task.
    pub steps: Vec<ShownStep>,
    /// The objects that the task is about.
    pub roles: Vec<ShownRole>,
    /// The reason why the recording could not be explained.
    pub fault: Option<String>,
}

/// A step of a [`ShownTask`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownStep {
    /// The step as a sentence.
    pub sentence: String,
    /// The tick in which its object was grasped.
    pub grasp: SimTick,
    /// The tick in which its object was released.
    pub release: SimTick,
    /// The colour of the object.
    pub color: Option<Rgb>,
    /// Id of the object that is moved.
    pub object: String,
    /// The relation that the step achieves: `on`, `inside`, `beside`, `on-table`, …
    pub relation: String,
    /// Id of the object that the relation refers to; `table` if it refers to none.
    pub reference: String,
    /// Goal of the object, in the frame of the reference; `None` if it is removed or only picked up.
    pub goal: Option<Pose>,
}

/// An object that a [`ShownTask`] is about.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownRole {
    /// Id of the object in the demonstration.
    pub id: String,
    /// Its name in the sentences.
    pub noun: String,
    /// The requirements on the object that takes its place.
    pub required: Required,
    /// The object's properties, each with whether it is required.
    pub properties: Vec<ShownProperty>,
}

/// The requirements on an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Required {
    /// It is to be the one most like the demonstrated object.
    #[default]
    AsShown,
    /// Nothing.
    Nothing,
    /// It is to have some of the properties.
    Some,
}

/// A property of an object, such as its colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownProperty {
    /// Its name.
    pub name: String,
    /// The value that the object has, or that is required of another one.
    pub value: String,
    /// True if an object needs it to take the place of this one.
    pub is_required: bool,
}
