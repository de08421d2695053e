//! A task as the sentences of a dataset.

use tabletop_core::SimTick;
use tabletop_task::{Relation, Task, TaskStep};

/// The task in a sentence a step; empty if nothing is done.
pub(crate) fn instruction(task: &Task) -> String {
    let mut sentences: Vec<_> = task
        .steps
        .iter()
        .map(|step| (step.grasp, step.sentence.clone()))
        .chain(
            task.operations
                .iter()
                .map(|done| (done.tick, done.sentence())),
        )
        .collect();
    sentences.sort_by_key(|(tick, _)| *tick);
    let sentences: Vec<_> = sentences.into_iter().map(|(_, text)| text).collect();
    sentences.join(" ")
}

/// The parts of the task, each with the tick that it begins after: an object is picked up until it is grasped, and put somewhere until it
/// is released.
pub(crate) fn parts(task: &Task, start: SimTick) -> Vec<(SimTick, String)> {
    let mut parts = Vec::new();
    let mut since = start;
    for step in &task.steps {
        let noun = task
            .role(&step.object)
            .map_or(step.object.as_str(), |role| &role.noun);
        parts.push((since, format!("pick up {noun}")));
        if step.relations.first() != Some(&Relation::Held) {
            parts.push((step.grasp, deed(step, noun)));
        }
        since = step.release;
    }
    parts
}

/// What is done with the object in hand: the step's sentence, in which the object is `it`.
fn deed(step: &TaskStep, noun: &str) -> String {
    clause(&step.sentence.replacen(noun, "it", 1))
}

/// A sentence as part of another.
fn clause(sentence: &str) -> String {
    let mut letters = sentence.trim_end_matches('.').chars();
    let first = letters.next().map(|letter| letter.to_ascii_lowercase());
    first.into_iter().chain(letters).collect()
}

/// Other words for the task.
pub(crate) fn paraphrases(task: &Task, instruction: &str) -> Vec<String> {
    let words = [
        ("Put ", "Place "),
        ("Pick up ", "Take "),
        ("Remove ", "Clear away "),
    ];
    let steps = task.steps.iter();
    let clauses: Vec<_> = steps.map(|step| clause(&step.sentence)).collect();
    let other = words
        .iter()
        .fold(instruction.to_owned(), |text, (from, to)| {
            text.replace(from, to)
        });
    let told = (!clauses.is_empty()).then(|| format!("Please {}.", clauses.join(", then ")));
    let mut all: Vec<_> = [Some(other), told].into_iter().flatten().collect();
    all.retain(|text| text != instruction && !text.is_empty());
    all
}
