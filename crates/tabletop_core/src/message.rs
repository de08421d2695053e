//! What the simulation is told, and what it tells.
//!
//! Whoever acts (mouse, keys, panels, a scenario, a replay, a test) writes the same [`SimCommand`]s; what came of them
//! is read from [`SimFact`]s. Both are streams in one order.

use std::path::PathBuf;

use bevy::{ecs::system::SystemState, prelude::*};
use serde::{Deserialize, Serialize};

use crate::{Arm, Drive, Face, Hand, Pose, Preset, RobotJoint, SceneSpec};

/// Something the simulation is to do in its next tick.
#[derive(Message, Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SimCommand {
    /// Read this task file and [set its scene](Self::SetScene).
    LoadTask(PathBuf),
    /// Clear the table and put this on it.
    SetScene(Box<SceneSpec>),
    /// Remove every object from the table that no hand holds.
    ClearTable,
    /// Make objects, without touching any that are there.
    Make {
        /// What to make.
        preset: Preset,
        /// Decides colours and place: the same seed makes the same in the same world.
        seed: u64,
    },
    /// Let mouse and panels act with this hand.
    SelectHand(Hand),
    /// Take an object into a hand.
    Grasp {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        object: String,
    },
    /// Move what a hand holds to this location, as far as nothing is in its way.
    MoveTo {
        /// The hand.
        hand: Hand,
        /// Where the object's origin is to be, in units.
        location: Vec3,
    },
    /// Move what a hand holds on from where it is to be.
    MoveBy {
        /// The hand.
        hand: Hand,
        /// How far, in units.
        offset: Vec3,
    },
    /// Turn what a hand holds about an axis of the world through the object's origin.
    Turn {
        /// The hand.
        hand: Hand,
        /// The axis; its length does not matter.
        axis: Vec3,
        /// The angle in degrees.
        degrees: f32,
    },
    /// Let go of what a hand holds.
    Release(Hand),
    /// Remove what a hand holds from the world.
    Destroy(Hand),
    /// Begin to record.
    StartRecording,
    /// End the recording.
    FinishRecording,
    /// Go back to where the present segment of the recording began, and discard it.
    Undo,
    /// Bring back the segment that was undone last.
    Redo,
    /// Stop the clock, or let it run on.
    SetPaused(bool),
    /// Put the robot to the table, or take it away.
    ShowRobot(bool),
    /// Move joints of the robot; of two orders for a joint in a tick the later one counts.
    Drive(Vec<(RobotJoint, Drive)>),
    /// Bring an end effector to a pose at the speed of manual control.
    ReachTo {
        /// The arm.
        arm: Arm,
        /// Where [the end effector](crate::ArmState::end_effector) is to be, in the table's frame.
        pose: Pose,
    },
    /// Show this face on the robot's screen.
    ShowFace(Face),
    /// Show these points, in the table's frame, instead of those shown before.
    ShowMarkers(Vec<Vec3>),
}

impl SimCommand {
    /// The commands that a system has not read yet and that it wants, in their order: for systems that carry them out
    /// one after the other, each on the world that the one before has left.
    ///
    /// # Errors
    ///
    /// The world has no such messages.
    pub fn unread(
        world: &mut World,
        reader: &mut SystemState<MessageReader<Self>>,
        is_wanted: impl Fn(&Self) -> bool,
    ) -> Result<Vec<Self>> {
        let mut commands = reader.get_mut(world)?;
        let wanted = commands.read().filter(|command| is_wanted(command));
        Ok(wanted.cloned().collect())
    }
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
    /// A hand is about to act: what follows belongs to a new segment of a recording.
    SegmentBegun,
    /// A hand has taken an object.
    Grasped {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has let go of an object.
    Released {
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has removed an object; its [`ObjectDeleted`](Self::ObjectDeleted) has come before.
    Destroyed {
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A recording has begun.
    RecordingStarted {
        /// Its folder.
        folder: PathBuf,
    },
    /// A recording has ended as it should.
    RecordingFinished {
        /// Its folder.
        folder: PathBuf,
    },
    /// A recording could not begin or go on. What was written of it before stays.
    RecordingFailed {
        /// Its folder.
        folder: PathBuf,
        /// What went wrong, and what can be done.
        reason: String,
    },
    /// The world is again as it was before the last segment of the recording began; the tick has gone back with it.
    Undone,
    /// The world is again as it was when the undone segment was undone; the tick has gone forward with it.
    Redone,
    /// The robot now stands at the table, or no longer does.
    RobotShown(bool),
    /// A gripper has closed on an object and holds it.
    GripMade {
        /// The arm.
        arm: Arm,
        /// Id of the object.
        id: String,
    },
    /// Both fingers of a closing gripper touch an object, and cannot hold it like this.
    GripRefused {
        /// The arm.
        arm: Arm,
        /// Id of the object.
        id: String,
        /// The angle θ of the report's figure 11, in rad, which had to be below π/16.
        angle: f32,
    },
    /// A gripper has let go of an object, or it was taken from it.
    GripReleased {
        /// The arm.
        arm: Arm,
        /// Id of the object.
        id: String,
    },
    /// An arm was stopped by something that it cannot push away; told once until it is free again.
    ArmBlocked {
        /// The arm.
        arm: Arm,
        /// What is in its way: an object's id, `table`, or a part of the robot.
        by: String,
    },
    /// Something could not be done as it was told.
    Refused {
        /// What and why.
        reason: String,
    },
}
