//! The imitation of the demonstrated task, as the user controls and watches it.

use bevy::prelude::*;

/// A request of the user about the demonstrated task. The crate that explains recordings reads it.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum TaskOrder {
    /// Require a property of an object, or no longer require it.
    Require {
        /// The [role's](tabletop_core::ShownRole) id.
        role: String,
        /// The property's name.
        property: String,
        /// True if it is required from now on.
        is_required: bool,
    },
    /// Let any object take the place of this one, or again only the one most like it.
    Free {
        /// The [role's](tabletop_core::ShownRole) id.
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
    /// Let the robot do what the [program](crate::TaughtProgram) says with the objects on the table.
    Perform,
    /// Take the next recording as one more demonstration of the program.
    ShowAgain,
    /// Put up the table on which this [other program](crate::TaughtProgram::others) acts differently, and take the next recording as one more demonstration.
    Ask(usize),
    /// This other program is the one that is meant.
    Answer(usize),
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
    Step(ImitatedStep),
}

/// A step that the robot does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImitatedStep {
    /// Its number, from 1.
    pub number: usize,
    /// The number of steps of the task; `None` for a program, whose steps are decided one after the other.
    pub of: Option<usize>,
    /// It in words.
    pub sentence: String,
    /// Number of earlier tries.
    pub tries: usize,
    /// True while the motion is still being planned.
    pub is_planning: bool,
}

impl Imitating {
    /// True while the robot imitates.
    pub const fn is_on(&self) -> bool {
        match self {
            Self::Idle => false,
            Self::Preparing | Self::Step(_) => true,
        }
    }
}
