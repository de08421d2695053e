//! Why there is no robot to look at or to drive.

use std::time::Duration;

use thiserror::Error;

use crate::{transport::TransportError, watchdog::StopReason};

/// Why there is no robot to look at or to drive.
#[derive(Debug, Error)]
pub enum BridgeError {
    /// The connection fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The robot does not say where its joints are.
    #[error("{robot} has not said within {} s where {} are: {topic} is silent, or the address is another robot's", .patience.as_secs_f64(), .joints.join(", "))]
    NoJoints {
        /// Its name.
        robot: String,
        /// The joints that are missing.
        joints: Vec<String>,
        /// The topic of joints.
        topic: String,
        /// How long it was waited for.
        patience: Duration,
    },
    /// The robot does not say whether it is on.
    #[error("{robot} has not said on {topic} within {} s whether it is on", .patience.as_secs_f64())]
    NoHealth {
        /// Its name.
        robot: String,
        /// The topic.
        topic: String,
        /// How long it was waited for.
        patience: Duration,
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
    /// The system gives no thread.
    #[error("no thread for the robot: {0}")]
    Thread(std::io::Error),
}
