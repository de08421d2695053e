//! Changes of single objects on the table.

use serde::{Deserialize, Serialize};

use crate::ObjectSpec;

/// A change of a single object on the table, which no hand makes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ObjectEdit {
    /// Put an object on the table. If its id is taken, it gets another one.
    Add(Box<ObjectSpec>),
    /// Put an object in the place of another one that no hand holds and no joint connects: the same one with another id, pose, size,
    /// colour, mass or friction. Its controls are in their first states, and it has its initial velocity.
    Change {
        /// Id of the object.
        object: String,
        /// The description of the new one, with its pose. The id is that of the old one, or a free one.
        spec: Box<ObjectSpec>,
    },
    /// Take an object that no hand holds from the table.
    Remove(String),
}
