//! Instructions: what is to be done with objects.

use serde::{Deserialize, Serialize};

use crate::noun::{Noun, Spot, Superlative, TableSide};

/// What is to be done with objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Instruction {
    /// They are put somewhere.
    Put {
        /// The objects.
        what: Noun,
        /// The place.
        to: TargetPlace,
        /// Their order.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        first: Option<Superlative>,
    },
    /// They are taken from the world.
    Remove {
        /// The objects.
        what: Noun,
        /// Their order.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        first: Option<Superlative>,
    },
    /// Their lids or drawers are opened.
    Open {
        /// The objects.
        what: Noun,
    },
    /// Their lids or drawers are closed.
    Close {
        /// The objects.
        what: Noun,
    },
    /// Two objects change places.
    Swap {
        /// One.
        one: Noun,
        /// The other.
        other: Noun,
    },
    /// What is on or around one object is moved to another, one by one, and nothing ever lies on anything smaller.
    MoveTower {
        /// Where the tower is.
        from: Noun,
        /// Where it is to be.
        to: Noun,
        /// Where parts of it may be meanwhile.
        by: Noun,
    },
    /// Like objects are arranged like these, elsewhere.
    Copy {
        /// The objects that are copied.
        what: Noun,
        /// The part of the table where the copy is made.
        to: TableSide,
    },
    /// A procedure is carried out.
    Call {
        /// The verb that names it.
        verb: String,
        /// Its objects.
        with: Vec<Noun>,
    },
}

/// Where objects are put.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "place", rename_all = "kebab-case", deny_unknown_fields)]
pub enum TargetPlace {
    /// At a spot.
    Spot(Spot),
    /// On the table, at this location in units.
    Location {
        /// To the right of the centre.
        x: f32,
        /// Away from the robot.
        y: f32,
    },
    /// Anywhere on the table, out of the way.
    Aside,
    /// Where another object was in the beginning.
    PlaceOf {
        /// The other object.
        noun: Noun,
    },
    /// In a pattern.
    Arranged {
        /// The pattern.
        pattern: Pattern,
        /// Where it is made.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<Spot>,
    },
}

/// A pattern of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// On each other.
    Tower,
    /// From left to right.
    Row,
    /// From near to far.
    Column,
    /// In rows of this many objects, 2 or more.
    Grid(u32),
}
