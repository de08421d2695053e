//! Why a step cannot be done.

use std::fmt;

use crate::stage::Stopped;

/// What went wrong, in words for who watches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanFailure {
    /// An object of the task is not there.
    Gone(String),
    /// No arm reaches it.
    OutOfReach(String),
    /// Nothing of it fits between the fingers as it stands.
    NoGrasp(String),
    /// It would have to be tipped over, and the robot takes things from above.
    Tipped(String),
    /// No way to take it there is free.
    NoWay(String),
    /// The fingers have closed, and it is not held.
    NotHeld(String),
    /// Something stopped the arm.
    Blocked {
        /// What was to be moved.
        object: String,
        /// What stopped it.
        by: String,
    },
    /// No free place was found for what is in the way.
    NoRoom(String),
    /// It was put down, and is not where it belongs.
    Misplaced(String),
    /// Somebody stopped the robot.
    Stopped,
}

impl From<Stopped> for PlanFailure {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl PlanFailure {
    /// The class of the failure, for a table.
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
                "{object} cannot be taken from above: nothing of it fits between the fingers"
            ),
            Self::Tipped(object) => write!(
                f,
                "{object} would have to be tipped, and it is only taken from above"
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
