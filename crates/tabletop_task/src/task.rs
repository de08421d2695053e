//! What is to be done.

use serde::{Deserialize, Serialize};
use tabletop_core::{JointSpec, Table};

use crate::{detour::Detour, operation::Operation, role::Role, step::TaskStep};

/// What a demonstration shows to be done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The table on which it was shown.
    pub table: Table,
    /// The objects that it is about, in the order in which its steps name them.
    pub roles: Vec<Role>,
    /// What connects the objects of the demonstration.
    pub joints: Vec<JointSpec>,
    /// What is done, in the order in which it was shown.
    pub steps: Vec<TaskStep>,
    /// What was done besides, and does not matter.
    pub detours: Vec<Detour>,
    /// What was operated, pointed to, fastened and loosened, in the order in which it was shown.
    #[serde(default)]
    pub operations: Vec<Operation>,
}

impl Task {
    /// The role of this id.
    pub fn role(&self, id: &str) -> Option<&Role> {
        self.roles.iter().find(|role| role.id == id)
    }

    /// The step of this number, from 1.
    pub fn step(&self, number: usize) -> Option<&TaskStep> {
        self.steps.get(number.checked_sub(1)?)
    }
}
