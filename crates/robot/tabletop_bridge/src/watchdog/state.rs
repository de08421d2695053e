//! The states of a watchdog, and the reasons to stop a robot.

use std::{fmt, time::Duration};

use crate::state::JointJump;

/// What a watchdog does.
#[derive(Clone, Debug, PartialEq)]
pub enum WatchdogState {
    /// It looks on and sends nothing.
    Watching,
    /// It passes on what the program wants.
    Armed,
    /// It brings the joints to rest.
    Ramping(StopReason),
    /// The robot stays where it is, and is no longer driven. Only a person starts it again.
    Held(StopReason),
}

/// Why a robot is no longer driven.
#[derive(Clone, Debug, PartialEq)]
pub enum StopReason {
    /// The program is done with it.
    Asked,
    /// Something ended the program, such as Ctrl-C.
    Interrupted(String),
    /// Its joints' states are old.
    StaleState {
        /// How old they are.
        age: Duration,
    },
    /// It has not said for too long whether it is on.
    SilentHealth {
        /// How long.
        age: Duration,
    },
    /// A joint's state changed by more than the joint can.
    Jump(JointJump),
    /// Somebody or something has stopped it.
    EmergencyStop,
    /// Its motors are off.
    Disabled,
    /// A part of it is faulty.
    RobotError,
    /// The program has set no target for too long.
    ProgramLate {
        /// How long.
        by: Duration,
    },
    /// This program was not running for too long.
    WatchdogLate {
        /// How long.
        by: Duration,
    },
    /// A joint is not where it should be.
    Deviation {
        /// The joint.
        joint: String,
        /// How far it is from there, in rad.
        by: f64,
    },
    /// A joint does not turn as it is ordered to.
    Unfollowed {
        /// The joint.
        joint: String,
    },
    /// Nobody listens to the commands.
    Unheard {
        /// The topic.
        topic: String,
    },
    /// A gripper that is to move reports an error.
    GripperError {
        /// Its limb.
        limb: String,
    },
    /// A gripper that is to move says nothing of itself.
    SilentGripper {
        /// Its limb.
        limb: String,
        /// For how long.
        age: Duration,
    },
    /// The connection is lost.
    Disconnected(String),
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = Duration::as_millis;
        match self {
            Self::Asked => f.write_str("the program is done"),
            Self::Interrupted(by) => f.write_str(by),
            Self::StaleState { age } => {
                write!(f, "the robot's joint states are {} ms old", ms(age))
            }
            Self::SilentHealth { age } => {
                write!(
                    f,
                    "the robot has not said for {} ms whether it is on",
                    ms(age)
                )
            }
            Self::Jump(jump) => jump.fmt(f),
            Self::EmergencyStop => f.write_str("the robot is stopped: a person must reset it"),
            Self::Disabled => f.write_str("the robot's motors are off"),
            Self::RobotError => f.write_str("the robot reports an error"),
            Self::ProgramLate { by } => write!(f, "the program set no target for {} ms", ms(by)),
            Self::WatchdogLate { by } => write!(f, "this computer stood still for {} ms", ms(by)),
            Self::Deviation { joint, by } => {
                write!(f, "{joint} is {by:.2} rad from where it should be")
            }
            Self::Unfollowed { joint } => {
                write!(
                    f,
                    "{joint} does not turn as it is ordered to: it is stuck, or commands do not reach it"
                )
            }
            Self::Unheard { topic } => write!(f, "nobody listens to commands on {topic}"),
            Self::GripperError { limb } => {
                write!(f, "the gripper of limb {limb} reports an error")
            }
            Self::SilentGripper { limb, age } => {
                write!(
                    f,
                    "the gripper of limb {limb} has said nothing for {} ms",
                    ms(age)
                )
            }
            Self::Disconnected(why) => f.write_str(why),
        }
    }
}

impl StopReason {
    /// True if the robot has already stopped by itself, so that commands make no sense.
    pub(super) fn is_robot_at_rest(&self) -> bool {
        match self {
            Self::EmergencyStop | Self::Disabled => true,
            // What can no longer be read may still be written to.
            Self::Disconnected(_)
            | Self::Asked
            | Self::Interrupted(_)
            | Self::StaleState { .. }
            | Self::SilentHealth { .. }
            | Self::Jump(_)
            | Self::RobotError
            | Self::ProgramLate { .. }
            | Self::WatchdogLate { .. }
            | Self::Deviation { .. }
            | Self::Unfollowed { .. }
            | Self::Unheard { .. }
            | Self::GripperError { .. }
            | Self::SilentGripper { .. } => false,
        }
    }
}
