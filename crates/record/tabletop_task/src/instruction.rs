//! A task in words, as instructions that a learner gets.

use tabletop_core::SimTick;

use crate::{relation::Relation, step::TaskStep, task::Task};

impl Task {
    /// The task in a sentence a step; empty if nothing is done.
    pub fn instruction(&self) -> String {
        let steps = self.told().into_iter();
        let steps = steps.map(|(tick, step)| (tick, step.sentence.clone()));
        let operations = self.operations.iter();
        let operations = operations.map(|done| (done.tick, done.sentence()));
        let mut sentences: Vec<_> = steps.chain(operations).collect();
        sentences.sort_by_key(|(tick, _)| *tick);
        let sentences: Vec<_> = sentences.into_iter().map(|(_, text)| text).collect();
        sentences.join(" ")
    }

    /// Its steps in their order, each with the tick at which it is told among other acts: when it begins or, if a later step has begun before, then.
    pub fn told(&self) -> Vec<(SimTick, &TaskStep)> {
        let mut next = SimTick(u64::MAX);
        let told = self.steps.iter().rev().map(|step| {
            next = next.min(step.grasp);
            (next, step)
        });
        let mut told: Vec<_> = told.collect();
        told.reverse();
        told
    }

    /// Its parts, each with the tick that it begins after: an object is picked up until it is grasped, and put somewhere until it is
    /// released. `start` is the first tick of the recording.
    pub fn parts(&self, start: SimTick) -> Vec<(SimTick, String)> {
        let mut ends = Vec::new();
        for step in &self.steps {
            if step.spilled.is_none() {
                ends.push((step.grasp, step, true));
            }
            if step.relations.first() != Some(&Relation::Held) {
                ends.push((step.release, step, false));
            }
        }
        ends.sort_by_key(|(end, ..)| *end);
        let mut since = start;
        let mut in_hand = None;
        let parts = ends.into_iter().map(|(end, step, is_grasp)| {
            let noun = self.noun(&step.object);
            let part = match is_grasp {
                true => format!("pick up {noun}"),
                false if in_hand == Some(&step.object) => deed(step, &noun),
                false => clause(&step.sentence),
            };
            in_hand = is_grasp.then_some(&step.object);
            (std::mem::replace(&mut since, end), part)
        });
        parts.collect()
    }

    /// Other words for its [instruction](Self::instruction).
    pub fn paraphrases(&self) -> Vec<String> {
        let words = [
            ("Put ", "Place "),
            ("Pick up ", "Take "),
            ("Remove ", "Clear away "),
        ];
        let instruction = self.instruction();
        let steps = self.steps.iter();
        let clauses: Vec<_> = steps.map(|step| clause(&step.sentence)).collect();
        let words = words.iter();
        let other = words.fold(instruction.clone(), |text, (from, to)| {
            text.replace(from, to)
        });
        let told = (!clauses.is_empty()).then(|| format!("Please {}.", clauses.join(", then ")));
        let mut all: Vec<_> = [Some(other), told].into_iter().flatten().collect();
        all.retain(|text| *text != instruction && !text.is_empty());
        all
    }
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
