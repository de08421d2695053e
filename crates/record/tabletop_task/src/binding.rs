//! Bindings: which objects of a table take the roles of a task.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use tabletop_core::ObjectSpec;

use crate::{
    assignment::{cheapest, shortage},
    property::{has_value, property},
    relation::Relation,
    requirement::Requirements,
    role::Role,
    sentence::listed,
    step::TaskStep,
    task::Task,
};

/// The id of an object for each role of a task, by the role's id.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Binding(pub BTreeMap<String, String>);

/// The reason why no objects fit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum Unbound {
    #[error("step {step}: nothing on the table can be {noun}: {reason}")]
    NoObject {
        step: usize,
        noun: String,
        reason: String,
    },
    #[error("{nouns} need an object each, and only {objects} can be {either}")]
    TooFew {
        nouns: String,
        objects: String,
        either: &'static str,
    },
}

impl Binding {
    /// The object of a role.
    pub fn object(&self, role: &str) -> Option<&str> {
        self.0.get(role).map(String::as_str)
    }
}

impl Task {
    /// Finds an object of the table for each role. It must meet the role's requirements; without requirements, it is the object of the same id,
    /// otherwise one of the same shape and size, preferably of the same colour. Equal candidates are taken in the order of the table.
    ///
    /// # Errors
    /// A role has no object, or several roles have too few between them.
    pub fn bind(
        &self,
        requirements: &Requirements,
        objects: &[ObjectSpec],
    ) -> Result<Binding, Unbound> {
        let groups = self.groups(requirements);
        let mut costs = Vec::new();
        for roles in &groups {
            let mut of_group = Vec::new();
            for object in objects {
                let all: Option<Vec<_>> = roles
                    .iter()
                    .map(|role| self.cost(requirements, role, object, objects))
                    .collect();
                of_group.push(all.map(|costs| costs.into_iter().sum()));
            }
            if of_group.iter().all(Option::is_none)
                && let Some(role) = roles.first()
            {
                return Err(self.no_object(requirements, role, objects));
            }
            costs.push(of_group);
        }
        let Some(chosen) = cheapest(&costs) else {
            let (rows, columns) = shortage(&costs);
            let nouns: Vec<_> = rows
                .iter()
                .map(|&row| groups[row][0].noun.clone())
                .collect();
            let ids: Vec<_> = columns
                .iter()
                .map(|&column| objects[column].id.clone())
                .collect();
            return Err(Unbound::TooFew {
                nouns: listed(&nouns),
                objects: listed(&ids),
                either: if nouns.len() == 2 {
                    "either"
                } else {
                    "any of them"
                },
            });
        };
        let bound = groups.iter().zip(chosen).flat_map(|(roles, object)| {
            let object = &objects[object].id;
            roles
                .iter()
                .map(move |role| (role.id.clone(), object.clone()))
        });
        Ok(Binding(bound.collect()))
    }

    /// Roles that have to take the same object.
    fn groups(&self, requirements: &Requirements) -> Vec<Vec<&Role>> {
        let mut groups = Vec::<Vec<&Role>>::new();
        for role in &self.roles {
            let same = requirements
                .same_as(&role.id)
                .and_then(|step| Some(self.step(step)?.object.as_str()));
            let mut joined: Vec<_> = vec![role];
            let is_same = |group: &Vec<&Role>| {
                group.iter().any(|other| {
                    let others = requirements.same_as(&other.id);
                    let others = others.and_then(|step| Some(self.step(step)?.object.as_str()));
                    same == Some(other.id.as_str()) || others == Some(role.id.as_str())
                })
            };
            let (together, apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_same);
            joined.extend(together.into_iter().flatten());
            groups = apart;
            groups.push(joined);
        }
        groups
    }

    /// The difference between an object and that of a role, as a cost; `None` if the object cannot take the role.
    fn cost(
        &self,
        requirements: &Requirements,
        role: &Role,
        object: &ObjectSpec,
        objects: &[ObjectSpec],
    ) -> Option<i64> {
        if self.moves(role) && object.is_fixed() && !role.shown.is_fixed() {
            return None;
        }
        let is_like = |name: &str| match (property(object, name), property(&role.shown, name)) {
            (Some(value), Some(shown)) => has_value(name, &value, &shown),
            (value, shown) => value == shown,
        };
        let unlike = |name: &str, cost| if is_like(name) { 0 } else { cost };
        if let Some(lacks) = requirements.lacks(&role.id, object) {
            return lacks.is_empty().then(|| {
                unlike("shape", 8) + unlike("size", 4) + unlike("color", 2) + unlike("id", 1)
            });
        }
        if objects.iter().any(|object| object.id == role.id) {
            return (object.id == role.id).then_some(0);
        }
        (is_like("shape") && is_like("size")).then(|| unlike("color", 2))
    }

    fn moves(&self, role: &Role) -> bool {
        self.steps.iter().any(|step| step.object == role.id)
    }

    fn no_object(
        &self,
        requirements: &Requirements,
        role: &Role,
        objects: &[ObjectSpec],
    ) -> Unbound {
        let is_meant = |step: &&TaskStep| {
            let others = step.relations.iter().filter_map(Relation::object);
            step.object == role.id || others.into_iter().any(|other| other == role.id)
        };
        let step = self
            .steps
            .iter()
            .find(is_meant)
            .map_or(1, |step| step.number);
        // The nearest candidate explains the failure best.
        let nearest = objects
            .iter()
            .filter_map(|object| Some((requirements.lacks(&role.id, object)?, object)))
            .min_by_key(|(lacks, _)| lacks.len());
        let reason = match nearest {
            _ if objects.is_empty() => "the table is empty".into(),
            Some((lacks, object)) if !lacks.is_empty() => {
                let has: Vec<_> = lacks
                    .iter()
                    .filter_map(|lack| {
                        let name = lack.split(' ').next()?;
                        let value = property(object, name);
                        Some(value.map_or_else(
                            || format!("no {name}"),
                            |value| format!("{name} {value}"),
                        ))
                    })
                    .collect();
                let (lacks, has) = (listed(&lacks), listed(&has));
                format!("{lacks} is required, and {} has {has}", object.id)
            }
            Some(_) => "the objects that would fit do not move".into(),
            None => {
                let kinds: BTreeSet<_> = objects
                    .iter()
                    .filter_map(|object| property(object, "shape"))
                    .collect();
                let shown = |name| property(&role.shown, name).unwrap_or_default();
                let kinds: Vec<_> = kinds.into_iter().collect();
                format!(
                    "there is neither an object {} nor a {} of size {} (there are shapes {})",
                    role.id,
                    shown("shape"),
                    shown("size"),
                    listed(&kinds)
                )
            }
        };
        Unbound::NoObject {
            step,
            noun: role.noun.clone(),
            reason,
        }
    }
}
