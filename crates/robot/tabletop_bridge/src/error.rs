//! Why there is no robot to look at or to drive.

use std::time::Duration;

use thiserror::Error;

use crate::{profile::BridgeProfile, transport::TransportError, watchdog::StopReason};

/// What is the matter with a topic on which a robot should say something.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TopicFault {
    /// Nobody publishes it.
    #[error("is published by nobody")]
    Unpublished,
    /// Its messages are of another type.
    #[error("is of the type {found}, not {expected}")]
    OtherType {
        /// The type.
        found: String,
        /// The expected one.
        expected: String,
    },
    /// It names other joints.
    #[error("names other joints ({}): the address is another robot's, or the profile", .0.join(", "))]
    OtherJoints(Vec<String>),
    /// Its messages make no sense.
    #[error("says nothing that makes sense")]
    Nonsense,
    /// Nothing comes.
    #[error("is silent")]
    Silent,
}

/// Why there is no robot to look at or to drive.
#[derive(Debug, Error)]
pub enum BridgeError {
    /// The connection fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The robot does not say where its joints are, or whether it is on.
    #[error("{robot} has not said within {} s {what}: {topic} {fault}", .patience.as_secs_f64())]
    Silent {
        /// Its name.
        robot: String,
        /// What it has not said.
        what: String,
        /// The topic.
        topic: String,
        /// What is the matter with the topic.
        fault: Box<TopicFault>,
        /// How long it was waited for.
        patience: Duration,
    },
    /// Its joints' states come too seldom.
    #[error("{robot} cannot be driven: {topic} comes {rate:.0} times a second; it takes 25")]
    SlowStates {
        /// Its name.
        robot: String,
        /// The topic of joints.
        topic: String,
        /// How often a second they come.
        rate: f64,
    },
    /// Its software is not what the profile was made for.
    #[error("{robot} has the software {found}, not {}; what it does with commands is not known", .known.join(" or "))]
    Software {
        /// Its name.
        robot: String,
        /// The version that it has, or that it says nothing of it.
        found: String,
        /// The versions that are known.
        known: Vec<String>,
    },
    /// It cannot be driven now.
    #[error("{robot} cannot be driven: {reason}")]
    NotReady {
        /// Its name.
        robot: String,
        /// The reason.
        reason: StopReason,
    },
    /// A gripper does not find out its range.
    #[error("the gripper of limb {limb:?} has not calibrated itself within {} s", .patience.as_secs_f64())]
    NotCalibrated {
        /// The limb's name.
        limb: String,
        /// How long it was waited for.
        patience: Duration,
    },
    /// There is no such limb.
    #[error("{robot} has no limb {limb:?}")]
    NoLimb {
        /// The robot's name.
        robot: String,
        /// The limb's.
        limb: String,
    },
    /// There is no such camera.
    #[error("{robot} has no camera {camera:?}")]
    NoCamera {
        /// The robot's name.
        robot: String,
        /// The camera's.
        camera: String,
    },
    /// A camera does not open.
    #[error("the camera {camera} does not open: {answer}")]
    CameraClosed {
        /// Its name.
        camera: String,
        /// The robot's answer.
        answer: String,
    },
    /// The share of the greatest speed makes no sense.
    #[error("the speed is {0}; it must be a share of the greatest one, above 0 and at most 1")]
    Speed(f64),
    /// There is no process that brings the robot to rest when this one is killed.
    #[error(
        "there is no sentinel for the robot, which would keep its speed if this program were killed: {0}"
    )]
    Sentinel(std::io::Error),
    /// The system gives no thread.
    #[error("no thread for the robot: {0}")]
    Thread(std::io::Error),
}

impl BridgeError {
    /// A robot of this interface has no limb of this name.
    pub(crate) fn no_limb(profile: &BridgeProfile, limb: String) -> Self {
        let robot = profile.robot.clone();
        Self::NoLimb { robot, limb }
    }
}
