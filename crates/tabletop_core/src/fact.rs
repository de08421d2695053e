//! Facts: what has happened in a tick, and which command it came of.

use std::path::PathBuf;

use bevy::prelude::*;

use crate::{Bond, CommandId, Hand, LimbName, Obstacle, Operator};

/// Something that has happened in this tick.
#[derive(Message, Clone, Debug, PartialEq)]
pub enum SimFact {
    /// A task file was read. Its scene is on the table in this tick, without the faulty elements.
    TaskLoaded {
        /// The command that it came of.
        cause: CommandId,
        /// The file.
        path: PathBuf,
        /// What is wrong with it, each with its place.
        faults: Vec<String>,
    },
    /// An object has appeared.
    ObjectCreated {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Its id.
        id: String,
        /// Its entity.
        object: Entity,
    },
    /// An object has gone.
    ObjectDeleted {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Its id.
        id: String,
    },
    /// A hand is about to act: what follows belongs to a new segment of a recording.
    SegmentBegun {
        /// The command that it came of.
        cause: CommandId,
    },
    /// A hand has taken an object.
    Grasped {
        /// The command that it came of.
        cause: CommandId,
        /// The hand.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has let go of an object.
    Released {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has removed an object; its [`ObjectDeleted`](Self::ObjectDeleted) has come before.
    Destroyed {
        /// The command that it came of.
        cause: CommandId,
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// Somebody has operated a control.
    Triggered {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Who.
        by: Operator,
        /// Id of the control.
        control: String,
    },
    /// A control has another state.
    ControlChanged {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Id of the control.
        control: String,
        /// The name of the state that it shows now.
        state: String,
    },
    /// A hand has pointed to something.
    PointedTo {
        /// The command that it came of.
        cause: CommandId,
        /// The hand.
        hand: Hand,
        /// Id of the part, or of the whole object.
        part: String,
        /// Id of the object.
        object: String,
    },
    /// A bond was made, or is tighter by a step.
    Fastened {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Who.
        by: Operator,
        /// What is bonded, and how tight it is now.
        bond: Bond,
    },
    /// A bond is looser by a step, or no more.
    Loosened {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Who.
        by: Operator,
        /// What is bonded, and how tight it is now.
        bond: Bond,
    },
    /// A recording has begun.
    RecordingStarted {
        /// The command that it came of.
        cause: CommandId,
        /// Its folder.
        folder: PathBuf,
    },
    /// A recording has ended as it should.
    RecordingFinished {
        /// The command that it came of.
        cause: CommandId,
        /// Its folder.
        folder: PathBuf,
    },
    /// A recording could not begin or go on. What was written of it before stays.
    RecordingFailed {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// Its folder.
        folder: PathBuf,
        /// What went wrong, and what can be done.
        reason: String,
    },
    /// The world is again as it was before the last segment of the recording began; the tick has gone back with it.
    Undone {
        /// The command that it came of.
        cause: CommandId,
    },
    /// The world is again as it was when the undone segment was undone; the tick has gone forward with it.
    Redone {
        /// The command that it came of.
        cause: CommandId,
    },
    /// The robot now stands at the table, or no longer does.
    RobotShown {
        /// The command that it came of.
        cause: CommandId,
        /// Whether it stands there now.
        shown: bool,
    },
    /// A gripper has closed on an object and holds it.
    GripMade {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
    },
    /// Both fingers of a closing gripper touch an object, and cannot hold it like this.
    GripRefused {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
        /// The angle θ of the report's figure 11, in rad, which had to be below π/16.
        angle: f32,
    },
    /// A gripper has let go of an object, or it was taken from it.
    GripReleased {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
    },
    /// An arm was stopped by something that it cannot push away; reported once until it is free again.
    ArmBlocked {
        /// The arm.
        arm: LimbName,
        /// What is in its way.
        by: Obstacle,
    },
    /// A command, or something else that was asked for, was not carried out.
    Refused {
        /// The command that it came of, if it came of one.
        cause: Option<CommandId>,
        /// What and why.
        reason: String,
    },
}
