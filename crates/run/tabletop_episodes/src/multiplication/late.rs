//! Late roles: objects of a task that are not there at its beginning, because something makes them.

use std::collections::BTreeSet;

use tabletop_core::ObjectSpec;
use tabletop_task::{Binding, Demonstration, Requirements, Task, Unbound};

/// The ids of objects that appear in a demonstration after its beginning. They are made again, with the same ids.
#[derive(Clone, Debug, Default)]
pub(super) struct LateObjects(BTreeSet<String>);

impl LateObjects {
    pub fn of(shown: &Demonstration) -> Self {
        let late = shown.objects.iter();
        let late = late.filter(|object| object.created > shown.start);
        Self(late.map(|object| object.spec.id.clone()).collect())
    }

    pub fn contains(&self, id: &str) -> bool {
        self.0.contains(id)
    }

    /// Finds an object for each role of a task among those that are there at the beginning, and for each late role itself.
    ///
    /// # Errors
    /// As of [`Task::bind`].
    pub fn bind(
        &self,
        task: &Task,
        requirements: &Requirements,
        objects: &[ObjectSpec],
    ) -> Result<Binding, Unbound> {
        let mut there = task.clone();
        let (late, roles) = there
            .roles
            .into_iter()
            .partition(|role| self.contains(&role.id));
        there.roles = roles;
        let mut binding = there.bind(requirements, objects)?;
        let late: Vec<tabletop_task::Role> = late;
        binding
            .0
            .extend(late.into_iter().map(|role| (role.id.clone(), role.id)));
        Ok(binding)
    }
}
