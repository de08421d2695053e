//! Failures of steps.

use std::fmt;

use crate::stage::Stopped;

/// The reason why a step failed, with words for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanFailure {
    /// An object of the task is missing.
    Gone(String),
    /// No arm gets its fingers around the object.
    OutOfReach(String),
    /// Something leaves the fingers no room around the object.
    Enclosed(String),
    /// No arm that reaches the object reaches where it belongs.
    PlaceOutOfReach(String),
    /// No part of the object fits between the fingers as it stands.
    NoGrasp(String),
    /// The object would have to be tipped over, and no grasp allows that.
    Tipped(String),
    /// Something that nothing moves is where the object belongs.
    Occupied {
        /// The object that was to be moved.
        object: String,
        /// The object that is there.
        by: String,
    },
    /// Something that nothing moves is in the way of a part that slides.
    Barred {
        /// The part that was to be slid.
        object: String,
        /// The object in its way.
        by: String,
    },
    /// No free path leads to the goal.
    NoWay(String),
    /// The fingers have closed without holding the object.
    NotHeld(String),
    /// The gripper of a real limb says that it holds nothing.
    EmptyHand {
        /// The limb.
        limb: String,
        /// The object that it was to hold.
        object: String,
    },
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
    /// The demonstration does not show where the object belongs.
    NoGoal(String),
    /// Something was to be taken where nothing is.
    NothingThere,
    /// It could not be decided what to do next, for this reason.
    Undecided(String),
    /// Ever more was to be done.
    Endless,
    /// The robot was stopped from outside.
    Stopped,
}

impl From<Stopped> for PlanFailure {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl PlanFailure {
    /// True if it was found before anything moved, so that taking the object from beside may do.
    pub(crate) const fn is_of_planning(&self) -> bool {
        match self {
            Self::OutOfReach(_)
            | Self::Enclosed(_)
            | Self::PlaceOutOfReach(_)
            | Self::NoGrasp(_)
            | Self::NoWay(_) => true,
            Self::Gone(_)
            | Self::Tipped(_)
            | Self::Occupied { .. }
            | Self::Barred { .. }
            | Self::NotHeld(_)
            | Self::EmptyHand { .. }
            | Self::Blocked { .. }
            | Self::NoRoom(_)
            | Self::Misplaced(_)
            | Self::NoGoal(_)
            | Self::NothingThere
            | Self::Undecided(_)
            | Self::Endless
            | Self::Stopped => false,
        }
    }

    /// Of this failure and a later one, that of the attempt which came farther.
    pub(crate) fn or(self, later: Self) -> Self {
        let progress = |failure: &Self| match failure {
            Self::NoGrasp(_) => 0,
            Self::OutOfReach(_) => 1,
            Self::Enclosed(_) => 2,
            Self::PlaceOutOfReach(_) => 3,
            Self::Tipped(_) | Self::NoWay(_) => 4,
            Self::Gone(_)
            | Self::Occupied { .. }
            | Self::Barred { .. }
            | Self::NotHeld(_)
            | Self::EmptyHand { .. }
            | Self::Blocked { .. }
            | Self::NoRoom(_)
            | Self::Misplaced(_)
            | Self::NoGoal(_)
            | Self::NothingThere
            | Self::Undecided(_)
            | Self::Endless
            | Self::Stopped => 5,
        };
        match progress(&later) >= progress(&self) {
            true => later,
            false => self,
        }
    }

    /// True if another try would come to the same.
    pub(crate) const fn is_final(&self) -> bool {
        match self {
            Self::OutOfReach(_)
            | Self::Enclosed(_)
            | Self::PlaceOutOfReach(_)
            | Self::NoGrasp(_)
            | Self::Tipped(_)
            | Self::Occupied { .. }
            | Self::Barred { .. }
            | Self::EmptyHand { .. }
            | Self::NoRoom(_)
            | Self::Gone(_)
            | Self::NoGoal(_)
            | Self::NothingThere
            | Self::Undecided(_)
            | Self::Endless
            | Self::Stopped => true,
            Self::NoWay(_) | Self::NotHeld(_) | Self::Blocked { .. } | Self::Misplaced(_) => false,
        }
    }

    /// Class of the failure, for a table.
    pub const fn class(&self) -> &'static str {
        match self {
            Self::Gone(_) => "gone",
            Self::OutOfReach(_) => "out of reach",
            Self::Enclosed(_) => "enclosed",
            Self::PlaceOutOfReach(_) => "place out of reach",
            Self::NoGrasp(_) => "no grasp",
            Self::Tipped(_) => "to be tipped",
            Self::Occupied { .. } => "occupied",
            Self::Barred { .. } => "barred",
            Self::NoWay(_) => "no way",
            Self::NotHeld(_) => "not held",
            Self::EmptyHand { .. } => "empty hand",
            Self::Blocked { .. } => "blocked",
            Self::NoRoom(_) => "no room",
            Self::Misplaced(_) => "misplaced",
            Self::NoGoal(_) => "no goal",
            Self::NothingThere => "nothing there",
            Self::Undecided(_) => "undecided",
            Self::Endless => "endless",
            Self::Stopped => "stopped",
        }
    }
}

impl fmt::Display for PlanFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gone(object) => write!(f, "{object} is no longer there"),
            Self::OutOfReach(object) => {
                write!(f, "no arm gets its fingers around {object} where it is")
            }
            Self::Enclosed(object) => {
                write!(
                    f,
                    "there is no room for fingers around {object} where it is"
                )
            }
            Self::PlaceOutOfReach(object) => {
                write!(f, "no arm that reaches {object} reaches where it belongs")
            }
            Self::NoGrasp(object) => write!(
                f,
                "{object} cannot be taken: no part of it fits between the fingers"
            ),
            Self::Tipped(object) => write!(
                f,
                "{object} would have to be tipped, and no grasp of it is free before and after that"
            ),
            Self::Occupied { object, by } => {
                write!(f, "{by} is where {object} belongs, and nothing moves it")
            }
            Self::Barred { object, by } => {
                write!(f, "{by} is in the way of {object}, and nothing moves it")
            }
            Self::NoWay(object) => {
                write!(f, "there is no free way for {object} to where it belongs")
            }
            Self::NotHeld(object) => write!(
                f,
                "the fingers have closed, and {object} is not between them"
            ),
            Self::EmptyHand { limb, object } => write!(
                f,
                "the gripper of limb {limb} holds nothing, where {object} was to be"
            ),
            Self::Blocked { object, by } => {
                write!(f, "{by} is in the way of the arm that moves {object}")
            }
            Self::NoRoom(object) => write!(f, "there is no free place on the table for {object}"),
            Self::Misplaced(object) => write!(f, "{object} is not where it was put"),
            Self::NoGoal(object) => write!(
                f,
                "{object} was let go in the air, so the demonstration does not show where it belongs"
            ),
            Self::NothingThere => write!(f, "something was to be taken where nothing is"),
            Self::Undecided(reason) => write!(f, "nothing was decided: {reason}"),
            Self::Endless => write!(f, "there was always something more to be done"),
            Self::Stopped => write!(f, "the robot was stopped"),
        }
    }
}
