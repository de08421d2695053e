//! The task that a recording shows, as panels and view know it.

use std::path::PathBuf;

use bevy::prelude::*;

use crate::{Pose, Rgb, Shape, SimTick};

/// The task that a recording shows, in words. Whoever understands recordings sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct ShownTask {
    /// The recording's folder.
    pub folder: PathBuf,
    /// What is done, in the order in which it was shown; nothing if there is no task.
    pub steps: Vec<ShownStep>,
    /// The objects that it is about.
    pub roles: Vec<ShownRole>,
    /// Why the recording could not be understood.
    pub fault: Option<String>,
}

/// A step of a [`ShownTask`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownStep {
    /// What it does, as a sentence.
    pub sentence: String,
    /// The tick in which its object was grasped.
    pub grasp: SimTick,
    /// The tick in which its object was let go of.
    pub release: SimTick,
    /// The colour of the object.
    pub color: Option<Rgb>,
    /// Id of the object that is moved.
    pub object: String,
    /// What is so afterwards: `on`, `inside`, `beside`, `on-table`, …
    pub relation: String,
    /// Id of the object to which that is a relation; `table` if it is to none.
    pub reference: String,
    /// Where the object is to be, in the frame of the reference: nowhere if it is removed or only picked up.
    pub goal: Option<Pose>,
}

/// An object that a [`ShownTask`] is about.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownRole {
    /// Id of the object with which it was shown.
    pub id: String,
    /// What it is called in the sentences.
    pub noun: String,
    /// What is required of the object that takes its place.
    pub required: Required,
    /// What the object has, and whether that is required.
    pub properties: Vec<ShownProperty>,
}

/// What is required of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Required {
    /// That it is most like the one with which the task was shown.
    #[default]
    AsShown,
    /// Nothing.
    Nothing,
    /// Some of its properties.
    Some,
}

/// A property of an object, such as its colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownProperty {
    /// Its name.
    pub name: String,
    /// What the object has, or what is required of another one.
    pub value: String,
    /// Whether an object must have it to take the place of this one.
    pub is_required: bool,
}

/// What the user wants with the task that was shown. Whoever understands it reads this.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum TaskOrder {
    /// Require a property of an object, or no longer.
    Require {
        /// The [role's](ShownRole) id.
        role: String,
        /// The property's name.
        property: String,
        /// Whether it is required from now on.
        is_required: bool,
    },
    /// Let any object take the place of this one, or again what is most like it.
    Free {
        /// The [role's](ShownRole) id.
        role: String,
        /// Whether any object may.
        is_free: bool,
    },
    /// Let the robot do it with what is on the table.
    Imitate,
    /// Let the robot stop doing it.
    Stop,
    /// Put everything to where it was in the beginning of the recording.
    PutBack,
}

/// How the robot gets on with the task that was shown. Whoever moves it sets this.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub enum Imitating {
    /// It does not do it.
    #[default]
    Idle,
    /// It comes to the table.
    Preparing,
    /// It does a step.
    Step {
        /// The number of the step, from 1.
        number: usize,
        /// How often it was tried before.
        tries: usize,
        /// Whether it is still to be found out how.
        is_planning: bool,
    },
}

impl Imitating {
    /// Whether the robot is busy with it.
    pub const fn is_on(&self) -> bool {
        match self {
            Self::Idle => false,
            Self::Preparing | Self::Step { .. } => true,
        }
    }
}

/// Where objects are going to be put: seen in the window as if through a veil, and nowhere else. Whoever moves them sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Ghosts(pub Vec<Ghost>);

/// Where an object is going to be put.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// Id of the object.
    pub id: String,
    /// Its shape.
    pub shape: Shape,
    /// Where it is going to be.
    pub pose: Pose,
    /// Whether it is the next one, to which a line leads from where the object is.
    pub is_next: bool,
}

impl Ghost {
    /// How much of what lies behind it is covered.
    pub const OPACITY: f32 = 0.35;
}
