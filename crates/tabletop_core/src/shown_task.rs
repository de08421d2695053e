//! The demonstrated task, as panels and view know it.

use std::path::PathBuf;

use bevy::prelude::*;

use crate::{Pose, Rgb, Shape, SimTick};

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

/// A request of the user about the demonstrated task. The crate that explains recordings reads it.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum TaskOrder {
    /// Require a property of an object, or no longer require it.
    Require {
        /// The [role's](ShownRole) id.
        role: String,
        /// The property's name.
        property: String,
        /// True if it is required from now on.
        is_required: bool,
    },
    /// Let any object take the place of this one, or again only the one most like it.
    Free {
        /// The [role's](ShownRole) id.
        role: String,
        /// True if any object may.
        is_free: bool,
    },
    /// Let the robot imitate the task with the objects on the table.
    Imitate,
    /// Stop the imitation.
    Stop,
    /// Put every object back where the recording began.
    PutBack,
}

/// The robot's progress with the demonstrated task. The crate that moves the robot sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub enum Imitating {
    /// The robot does not imitate.
    #[default]
    Idle,
    /// The robot is being put at the table.
    Preparing,
    /// The robot does a step.
    Step {
        /// The number of the step, from 1.
        number: usize,
        /// Number of earlier tries.
        tries: usize,
        /// True while the motion is still being planned.
        is_planning: bool,
    },
}

impl Imitating {
    /// True while the robot imitates.
    pub const fn is_on(&self) -> bool {
        match self {
            Self::Idle => false,
            Self::Preparing | Self::Step { .. } => true,
        }
    }
}

/// Ghosts: translucent previews in the window, and only there, of objects at their goals. The crate that moves the objects sets them.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Ghosts(pub Vec<Ghost>);

/// The preview of an object at its goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// Id of the object.
    pub id: String,
    /// Its shape.
    pub shape: Shape,
    /// Its goal.
    pub pose: Pose,
    /// True for the next object to be moved: a line leads to the ghost from the object.
    pub is_next: bool,
}

impl Ghost {
    /// Opacity of a ghost, from 0 to 1.
    pub const OPACITY: f32 = 0.35;
}
