//! The steps of a scenario, as in its file.

use std::path::PathBuf;

use bevy::prelude::*;
use serde::Deserialize;
use tabletop_core::{Hand, Preset};
use tabletop_program::TaskProgram;

use crate::{
    Check, RandomPlace, RobotStep,
    fault::{fault_of_time, fault_of_vector},
};

/// A step of a scenario: something that the demonstrator does, waits for or checks.
///
/// Lengths are in units of 10 cm, angles in degrees, times in seconds of simulated time. Unless a step says otherwise, the
/// selected hand acts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// Clear the table and load a task file.
    Load {
        /// The task file, relative to the scenario's folder.
        file: PathBuf,
        /// Objects that are moved to random places.
        #[serde(default)]
        place: Vec<RandomPlace>,
    },
    /// Remove every object that no hand holds.
    Clear,
    /// Make objects at a random free place over the table.
    Make(Preset),
    /// Let the following steps act with this hand.
    Select(Hand),
    /// Let one step act with another hand than the selected one.
    With(Hand, Box<Step>),
    /// Take the object of this id.
    Grasp(String),
    /// Move the held object to this location at a hand's full speed.
    MoveTo(Vec3),
    /// Move the held object by this vector at a hand's full speed.
    MoveBy(Vec3),
    /// Move the held object evenly to a location in a given time, and wait until the time is over.
    Glide {
        /// The location.
        to: Vec3,
        /// The time.
        seconds: f32,
    },
    /// Turn the held object about an axis of the world through its origin.
    Turn {
        /// The axis.
        axis: Axis,
        /// The angle.
        degrees: f32,
    },
    /// Release the held object.
    Release,
    /// Remove the held object from the world.
    Destroy,
    /// Press the switch with this id, or trigger the first part of a control that leads to another state.
    Trigger(String),
    /// Trigger the simple shape of this number, from 0, in the present state of a control.
    TriggerPart(String, u32),
    /// Point to the object or part of this id.
    PointTo(String),
    /// Fasten the guest point or object of this id to the nearest host, or by a step.
    Fasten(String),
    /// Loosen the guest point or object of this id by a step.
    Loosen(String),
    /// Close the scissors that the object of this id is a blade of.
    Cut(String),
    /// Carry out a program of tasks, in sentences such as `Put every red block into the box.`
    Do(String),
    /// Wait this many seconds.
    Wait(f32),
    /// Wait until everything is at rest, at most this many seconds.
    WaitUntilRest(f32),
    /// Wait until the held object has arrived or is stopped, at most this many seconds.
    WaitUntilThere(f32),
    /// Start a recording.
    Start,
    /// Finish the recording.
    Finish,
    /// Undo the last segment of the recording.
    Undo,
    /// Bring back the segment that was undone last.
    Redo,
    /// Pause or resume the simulation. Waiting continues during a pause, but hands cannot act.
    Pause(bool),
    /// Command the robot.
    Robot(RobotStep),
    /// Fail unless this check holds.
    Expect(Check),
}

/// An axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Axis {
    /// To the right.
    X,
    /// Away from the robot.
    Y,
    /// Up.
    Z,
}

impl Axis {
    /// The unit vector along it.
    pub const fn direction(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

impl Step {
    /// True if it changes nothing in the world: it waits, checks or records.
    pub(crate) const fn is_idle(&self) -> bool {
        match self {
            Self::Wait(_)
            | Self::WaitUntilRest(_)
            | Self::WaitUntilThere(_)
            | Self::Start
            | Self::Finish
            | Self::Pause(_)
            | Self::Select(_)
            | Self::Expect(_)
            | Self::Robot(RobotStep::WaitUntilStill(_) | RobotStep::Face(_)) => true,
            Self::Load { .. }
            | Self::Clear
            | Self::Make(_)
            | Self::With(..)
            | Self::Grasp(_)
            | Self::MoveTo(_)
            | Self::MoveBy(_)
            | Self::Glide { .. }
            | Self::Turn { .. }
            | Self::Release
            | Self::Destroy
            | Self::Trigger(_)
            | Self::TriggerPart(..)
            | Self::PointTo(_)
            | Self::Fasten(_)
            | Self::Loosen(_)
            | Self::Cut(_)
            | Self::Do(_)
            | Self::Undo
            | Self::Redo
            | Self::Robot(
                RobotStep::Show
                | RobotStep::Hide
                | RobotStep::Move(_)
                | RobotStep::Set(_)
                | RobotStep::Home
                | RobotStep::ReachTo { .. }
                | RobotStep::Close(_)
                | RobotStep::Open(_),
            ) => false,
        }
    }

    /// True if it lets time pass for something to happen.
    pub(crate) fn waits(&self) -> bool {
        match self {
            Self::With(_, step) => step.waits(),
            Self::Glide { .. }
            | Self::Do(_)
            | Self::Wait(_)
            | Self::WaitUntilRest(_)
            | Self::WaitUntilThere(_)
            | Self::Robot(RobotStep::WaitUntilStill(_)) => true,
            Self::Load { .. }
            | Self::Clear
            | Self::Make(_)
            | Self::Select(_)
            | Self::Grasp(_)
            | Self::MoveTo(_)
            | Self::MoveBy(_)
            | Self::Turn { .. }
            | Self::Release
            | Self::Destroy
            | Self::Trigger(_)
            | Self::TriggerPart(..)
            | Self::PointTo(_)
            | Self::Fasten(_)
            | Self::Loosen(_)
            | Self::Cut(_)
            | Self::Start
            | Self::Finish
            | Self::Undo
            | Self::Redo
            | Self::Pause(_)
            | Self::Robot(
                RobotStep::Show
                | RobotStep::Hide
                | RobotStep::Move(_)
                | RobotStep::Set(_)
                | RobotStep::Home
                | RobotStep::ReachTo { .. }
                | RobotStep::Close(_)
                | RobotStep::Open(_)
                | RobotStep::Face(_),
            )
            | Self::Expect(_) => false,
        }
    }

    /// Its fault, if it makes no sense.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Self::Load { place, .. } => place.iter().find_map(RandomPlace::fault),
            Self::Make(preset) => preset.fault(),
            Self::With(_, step) if !step.is_done_by_a_hand() => {
                Some("`With` must be followed by a step that a hand does".to_owned())
            }
            Self::With(_, step) => step.fault(),
            Self::MoveTo(vector) | Self::MoveBy(vector) => fault_of_vector(*vector),
            Self::Glide { to, seconds } => fault_of_vector(*to).or_else(|| fault_of_time(*seconds)),
            Self::Turn { degrees, .. } => {
                (!degrees.is_finite()).then(|| format!("{degrees} is not an angle"))
            }
            Self::Wait(seconds) | Self::WaitUntilRest(seconds) | Self::WaitUntilThere(seconds) => {
                fault_of_time(*seconds)
            }
            Self::Robot(step) => step.fault(),
            Self::Expect(check) => check.fault(),
            Self::Do(sentences) => {
                let program = sentences.parse::<TaskProgram>();
                program.err().map(|fault| fault.to_string())
            }
            Self::Clear
            | Self::Select(_)
            | Self::Grasp(_)
            | Self::Release
            | Self::Destroy
            | Self::Trigger(_)
            | Self::TriggerPart(..)
            | Self::PointTo(_)
            | Self::Fasten(_)
            | Self::Loosen(_)
            | Self::Cut(_)
            | Self::Start
            | Self::Finish
            | Self::Undo
            | Self::Redo
            | Self::Pause(_) => None,
        }
    }

    /// True if a hand does it.
    pub(crate) const fn is_done_by_a_hand(&self) -> bool {
        match self {
            Self::Grasp(_)
            | Self::MoveTo(_)
            | Self::MoveBy(_)
            | Self::Glide { .. }
            | Self::Turn { .. }
            | Self::Release
            | Self::Destroy
            | Self::Trigger(_)
            | Self::TriggerPart(..)
            | Self::PointTo(_)
            | Self::Fasten(_)
            | Self::Loosen(_)
            | Self::Cut(_)
            | Self::Do(_)
            | Self::WaitUntilThere(_) => true,
            Self::Load { .. }
            | Self::Clear
            | Self::Make(_)
            | Self::Select(_)
            | Self::With(..)
            | Self::Wait(_)
            | Self::WaitUntilRest(_)
            | Self::Start
            | Self::Finish
            | Self::Undo
            | Self::Redo
            | Self::Pause(_)
            | Self::Robot(_)
            | Self::Expect(_) => false,
        }
    }
}
