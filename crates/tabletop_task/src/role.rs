//! The objects that a task is about.

use serde::{Deserialize, Serialize};
use tabletop_core::ObjectSpec;

use crate::symmetry::Symmetry;

/// An object of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Role {
    /// Id of the object with which it was shown; steps name it by this.
    pub id: String,
    /// What it is called in sentences, such as `the red block`.
    pub noun: String,
    /// The object with which it was shown, where it was in the beginning.
    pub shown: ObjectSpec,
    /// Which turns leave it as it looks.
    pub symmetry: Symmetry,
}
