//! Facts: the events of a tick, each with the command that caused it.

use std::path::PathBuf;

use bevy::prelude::*;
use serde::Serialize;

use crate::{Bond, CommandId, Hand, LimbName, Obstacle, Operator};

/// An event of this tick. They are nested by the part that reports them, as commands are by the part that carries them out.
#[derive(Message, Clone, Debug, PartialEq, Serialize)]
pub enum SimFact {
    /// An event of the scene.
    Scene(SceneFact),
    /// An event of the history of a recording.
    History(HistoryFact),
    /// An event of a hand.
    Hand(HandFact),
    /// An event of a control, a bond or scissors.
    Mechanism(MechanismFact),
    /// An event of a recording.
    Recording(RecordingFact),
    /// An event of the robot.
    Robot(RobotFact),
    /// A command, or another request, was not carried out.
    Refused {
        /// The command that was refused, if it was one.
        cause: Option<CommandId>,
        /// The request, and the reason for the refusal.
        reason: String,
    },
}

/// An event of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum SceneFact {
    /// A task file was read. Its scene is on the table in this tick, but for the faulty elements.
    TaskLoaded {
        /// The command that caused it.
        cause: CommandId,
        /// The file.
        path: PathBuf,
        /// Its faults, each with its place.
        faults: Vec<String>,
    },
    /// An object has appeared.
    ObjectCreated {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// Its id.
        id: String,
        /// Its entity.
        #[serde(skip)]
        object: Entity,
    },
    /// An object has gone.
    ObjectDeleted {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// Its id.
        id: String,
    },
}

/// An event of the history of a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum HistoryFact {
    /// A hand is about to act: a new segment of the recording begins.
    SegmentBegun {
        /// The command that caused it.
        cause: CommandId,
    },
    /// Outside a recording, the world is kept as it is before a command changes it, so that the change can be undone.
    Kept {
        /// The command.
        cause: CommandId,
    },
    /// The world, its tick included, is back where the recording's last segment began.
    Undone {
        /// The command that caused it.
        cause: CommandId,
    },
    /// The world, its tick included, is back where the segment was undone.
    Redone {
        /// The command that caused it.
        cause: CommandId,
    },
}

/// An event of a hand.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum HandFact {
    /// A hand has taken an object.
    Grasped {
        /// The command that caused it.
        cause: CommandId,
        /// The hand.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has let go of an object.
    Released {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
    /// A hand has removed an object; its [`ObjectDeleted`](SceneFact::ObjectDeleted) comes before this.
    Destroyed {
        /// The command that caused it.
        cause: CommandId,
        /// The hand that held it.
        hand: Hand,
        /// Id of the object.
        id: String,
    },
}

/// An event of a control, a bond or scissors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum MechanismFact {
    /// A control was operated.
    Triggered {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// The operator.
        by: Operator,
        /// Id of the control.
        control: String,
    },
    /// A control has another state.
    ControlChanged {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// Id of the control.
        control: String,
        /// Name of the state that it now shows.
        state: String,
    },
    /// A hand has pointed to something.
    PointedTo {
        /// The command that caused it.
        cause: CommandId,
        /// The hand.
        hand: Hand,
        /// Id of the part, or of the whole object.
        part: String,
        /// Id of the object.
        object: String,
    },
    /// A bond was made, or tightened by a step.
    Fastened {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// The operator.
        by: Operator,
        /// The bond with its new tightness.
        bond: Bond,
    },
    /// A bond was loosened by a step, or undone.
    Loosened {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// The operator.
        by: Operator,
        /// The bond with its new tightness.
        bond: Bond,
    },
    /// A link of a chain was cut; its [`ObjectDeleted`](SceneFact::ObjectDeleted) comes after.
    Cut {
        /// The command that caused it, if any.
        cause: Option<CommandId>,
        /// Who has closed the scissors.
        by: Operator,
        /// Id of the first blade.
        blade: String,
        /// Id of the link.
        link: String,
    },
}

/// An event of a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum RecordingFact {
    /// A recording has begun.
    Started {
        /// The command that caused it.
        cause: CommandId,
        /// Its folder.
        folder: PathBuf,
        /// The folder of the earlier recording that was in its place.
        moved_aside: Option<PathBuf>,
    },
    /// A recording has ended properly.
    Finished {
        /// The command that caused it.
        cause: CommandId,
        /// Its folder.
        folder: PathBuf,
    },
    /// A recording could not begin or go on. Lines written before stay.
    Failed {
        /// The command that caused it, if one did.
        cause: Option<CommandId>,
        /// Its folder.
        folder: PathBuf,
        /// The fault, with a remedy.
        reason: String,
    },
}

/// An event of the robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum RobotFact {
    /// The robot was put at the table, or taken away.
    Shown {
        /// The command that caused it.
        cause: CommandId,
        /// True if it now stands there.
        shown: bool,
    },
    /// A gripper has closed on an object and holds it.
    GripMade {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
    },
    /// Both fingers of a closing gripper touch an object, but at an angle at which they cannot hold it.
    GripRefused {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
        /// The angle θ of the report's figure 11, in rad. It has to be below π/16.
        angle: f32,
    },
    /// A gripper has let go of an object, or the object was taken from it.
    GripReleased {
        /// The arm.
        arm: LimbName,
        /// Id of the object.
        id: String,
    },
    /// An obstacle that the arm cannot push away has stopped it. Reported once, until the arm is free again.
    ArmBlocked {
        /// The arm.
        arm: LimbName,
        /// The obstacle.
        by: Obstacle,
    },
}

impl From<SceneFact> for SimFact {
    fn from(fact: SceneFact) -> Self {
        Self::Scene(fact)
    }
}

impl From<HistoryFact> for SimFact {
    fn from(fact: HistoryFact) -> Self {
        Self::History(fact)
    }
}

impl From<HandFact> for SimFact {
    fn from(fact: HandFact) -> Self {
        Self::Hand(fact)
    }
}

impl From<MechanismFact> for SimFact {
    fn from(fact: MechanismFact) -> Self {
        Self::Mechanism(fact)
    }
}

impl From<RecordingFact> for SimFact {
    fn from(fact: RecordingFact) -> Self {
        Self::Recording(fact)
    }
}

impl From<RobotFact> for SimFact {
    fn from(fact: RobotFact) -> Self {
        Self::Robot(fact)
    }
}
