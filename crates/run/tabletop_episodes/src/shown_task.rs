//! Tasks in words, for panels and scripts.

use std::path::Path;

use tabletop_core::{Required, ShownProperty, ShownRole, ShownStep, ShownTask};
use tabletop_geometry::NAMED_COLORS;
use tabletop_task::{
    Binding, Reference, Requirements, Role, Task, TaskStep, has_value, properties, property,
};

/// A task, with its requirements in its sentences. Its objects are those that take its roles, if known, otherwise the demonstrated ones.
pub fn shown_task(
    folder: &Path,
    task: &Task,
    requirements: &Requirements,
    binding: Option<&Binding>,
) -> ShownTask {
    let mut task = task.clone();
    task.phrase(requirements);
    let steps = task
        .steps
        .iter()
        .map(|step| shown_step(&task, step, binding));
    let roles = task.roles.iter().map(|role| shown_role(role, requirements));
    ShownTask {
        folder: folder.to_owned(),
        steps: steps.collect(),
        roles: roles.collect(),
        fault: None,
    }
}

fn shown_step(task: &Task, step: &TaskStep, binding: Option<&Binding>) -> ShownStep {
    let color = |id: &str| {
        let shape = &task.role(id)?.shown.shape;
        shape.drawn().first().map(|solid| solid.color)
    };
    let bound = |role: &str| {
        let object = binding.and_then(|binding| binding.object(role));
        object.unwrap_or(role).to_owned()
    };
    let reference = step.goal.as_ref().map(|goal| match &goal.reference {
        Reference::Table => "table".to_owned(),
        Reference::Object { object } | Reference::PlaceOf { object } => bound(object),
        Reference::Itself => bound(&step.object),
    });
    ShownStep {
        sentence: step.sentence.clone(),
        grasp: step.grasp,
        release: step.release,
        color: color(&step.object),
        object: bound(&step.object),
        relation: step
            .relations
            .first()
            .map_or("", |first| first.name())
            .to_owned(),
        reference: reference.unwrap_or_else(|| "table".to_owned()),
        goal: step.goal.as_ref().map(|goal| goal.pose),
    }
}

fn shown_role(role: &Role, requirements: &Requirements) -> ShownRole {
    let required = requirements.roles.get(&role.id);
    let value_of = |name: &str| required.and_then(|required| required.get(name));
    let mut known: Vec<_> = properties(&role.shown)
        .into_iter()
        .map(|(name, _)| ShownProperty {
            is_required: value_of(&name).is_some(),
            value: value_of(&name).map_or_else(|| value(role, &name), String::clone),
            name,
        })
        .collect();
    // Requirements in the file that are no property of the object, such as being the object of another step.
    let others = required.into_iter().flatten();
    let others = others.filter(|(name, _)| !known.iter().any(|property| property.name == **name));
    let others: Vec<_> = others
        .map(|(name, value)| ShownProperty {
            name: name.clone(),
            value: value.clone(),
            is_required: true,
        })
        .collect();
    known.extend(others);
    ShownRole {
        id: role.id.clone(),
        noun: role.noun.clone(),
        required: match required {
            None => Required::AsShown,
            Some(required) if required.is_empty() => Required::Nothing,
            Some(_) => Required::Some,
        },
        properties: known,
    }
}

/// The value of a role's property: a colour by its name.
pub fn value(role: &Role, name: &str) -> String {
    let value = property(&role.shown, name).unwrap_or_default();
    if name == "color" {
        let mut names = NAMED_COLORS.iter();
        let fitting = names.find(|(known, _)| has_value(name, &value, known));
        return fitting.map_or(value, |(known, _)| (*known).to_owned());
    }
    value
}
