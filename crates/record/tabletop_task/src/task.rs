//! Tasks.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use tabletop_core::{JointSpec, Table};

use crate::{detour::Detour, operation::Operation, push::Push, role::Role, step::TaskStep};

/// The task that a demonstration teaches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The table of the demonstration.
    pub table: Table,
    /// The objects that it is about, in the order in which its steps name them.
    pub roles: Vec<Role>,
    /// Joints between the objects of the demonstration.
    pub joints: Vec<JointSpec>,
    /// Steps, in the order of the demonstration.
    pub steps: Vec<TaskStep>,
    /// Detours that do not matter.
    pub detours: Vec<Detour>,
    /// Objects that others moved on their way, for good.
    #[serde(default)]
    pub pushes: Vec<Push>,
    /// Objects that were operated, pointed to, fastened and loosened, in the order of the demonstration.
    #[serde(default)]
    pub operations: Vec<Operation>,
    /// Ids, shapes and descriptions of all objects of the demonstration: the values of each of these properties.
    #[serde(default)]
    pub vocabulary: BTreeMap<String, BTreeSet<String>>,
    /// The names in sentences of all objects of the demonstration, by id.
    #[serde(default)]
    pub nouns: BTreeMap<String, String>,
}

impl Task {
    /// Nothing to be done on a table.
    pub const fn without_steps(table: Table) -> Self {
        Self {
            table,
            roles: Vec::new(),
            joints: Vec::new(),
            steps: Vec::new(),
            detours: Vec::new(),
            pushes: Vec::new(),
            operations: Vec::new(),
            vocabulary: BTreeMap::new(),
            nouns: BTreeMap::new(),
        }
    }

    /// The role with this id.
    pub fn role(&self, id: &str) -> Option<&Role> {
        self.roles.iter().find(|role| role.id == id)
    }

    /// The name of an object in sentences: that of its role, if it has one.
    pub fn noun(&self, id: &str) -> String {
        let role = self.role(id).map(|role| &role.noun);
        let noun = role.or_else(|| self.nouns.get(id));
        noun.map_or_else(|| id.to_owned(), String::clone)
    }

    /// The step with this number, from 1.
    pub fn step(&self, number: usize) -> Option<&TaskStep> {
        self.steps.get(number.checked_sub(1)?)
    }
}
