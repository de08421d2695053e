//! Failures of steps.

use std::fmt;

use crate::stage::Stopped;

/// The reason why a step failed, with words for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanFailure {
    /// An object of the task is missing.
    Gone(String),
    /// No arm reaches the object.
    OutOfReach(String),
    /// No part of the object fits between the fingers as it stands.
    NoGrasp(String),
    /// The object would have to be tipped over, and the robot puts objects down as they stand.
    Tipped(String),
    /// No free path leads to the goal.
    NoWay(String),
    /// The fingers have closed without holding the object.
    NotHeld(String),
    /// An obstacle stopped the arm.
    Blocked {
        /// The object that was to be moved.
        object: String,
        /// The obstacle.
        by: String,
    },
    /// No free place was found for an object that is in the way.
    NoRoom(String),
    /// The object was put down but is not where it belongs.
    Misplaced(String),
    /// The robot was stopped from outside.
    Stopped,
}

impl From<Stopped> for PlanFailure {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl PlanFailure {
    /// Class of the failure, for a table.
    pub const fn class(&self) -> &'static str {
        match self {
            Self::Gone(_) => "gone",
            Self::OutOfReach(_) => "out of reach",
            Self::NoGrasp(_) => "no grasp",
            Self::Tipped(_) => "to be tipped",
            Self::NoWay(_) => "no way",
            Self::NotHeld(_) => "not held",
            Self::Blocked { .. } => "blocked",
            Self::NoRoom(_) => "no room",
            Self::Misplaced(_) => "misplaced",
            Self::Stopped => "stopped",
        }
    }
}

impl fmt::Display for PlanFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gone(object) => write!(f, "{object} is no longer there"),
            Self::OutOfReach(object) => write!(f, "no arm reaches {object} and where it belongs"),
            Self::NoGrasp(object) => write!(
                f,
                "{object} cannot be taken: no part of it fits between the fingers"
            ),
            Self::Tipped(object) => write!(
                f,
                "{object} would have to be tipped, and it is put down as it stands"
            ),
            Self::NoWay(object) => {
                write!(f, "there is no free way for {object} to where it belongs")
            }
            Self::NotHeld(object) => write!(
                f,
                "the fingers have closed, and {object} is not between them"
            ),
            Self::Blocked { object, by } => {
                write!(f, "{by} is in the way of the arm that moves {object}")
            }
            Self::NoRoom(object) => write!(f, "there is no free place on the table for {object}"),
            Self::Misplaced(object) => write!(f, "{object} is not where it was put"),
            Self::Stopped => write!(f, "the robot was stopped"),
        }
    }
}
