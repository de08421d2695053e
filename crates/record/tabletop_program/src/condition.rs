//! Conditions on the world.

use serde::{Deserialize, Serialize};

use crate::noun::{Noun, ObjectKind, Spot};

/// A condition on the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "if", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Condition {
    /// Something is somewhere.
    Is {
        /// It.
        what: Noun,
        /// True if it is not there.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        not: bool,
        /// The place.
        spot: Spot,
    },
    /// A lid or a drawer is open.
    IsOpen {
        /// Its box.
        what: Noun,
    },
    /// A lid or a drawer is closed.
    IsClosed {
        /// Its box.
        what: Noun,
    },
    /// Something, with all that stands on it, is a tower of at least this many objects.
    IsHigh {
        /// It.
        what: Noun,
        /// The number, 2 or more.
        count: u32,
    },
    /// There is nothing of a kind.
    ThereIsNo {
        /// The kind.
        of: ObjectKind,
    },
    /// There are at least this many objects of a kind.
    ThereAre {
        /// The number, 1 or more.
        count: u32,
        /// The kind.
        of: ObjectKind,
    },
    /// There are more objects of one kind than of another.
    ThereAreMore {
        /// The kind that there is more of.
        of: ObjectKind,
        /// The other one.
        than: ObjectKind,
    },
}
