//! Roles: the objects that a task is about.

use serde::{Deserialize, Serialize};
use tabletop_core::ObjectSpec;

use crate::symmetry::Symmetry;

/// A role of a task, which an object takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Role {
    /// Id of the demonstrated object; steps name the role by it.
    pub id: String,
    /// Its name in sentences, such as `the red block`.
    pub noun: String,
    /// The demonstrated object, with its first pose.
    pub shown: ObjectSpec,
    /// The rotations that leave its look unchanged.
    pub symmetry: Symmetry,
}

impl Role {
    /// True if it is the lid of a box.
    pub(crate) fn is_lid(&self) -> bool {
        self.shown.shape.name() == "lid"
    }
}
