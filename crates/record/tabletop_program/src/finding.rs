//! What demonstrations mean: the shortest programs that explain them.

mod branches;
mod conditions;
mod example;
mod explanation;
mod length;
mod nouns;
mod proposals;
mod search;
mod towers;
mod untouched;
mod variation;

use tabletop_task::{Demonstration, Task};

use crate::{program::TaskProgram, scene::TableScene};

pub use example::Example;
pub use untouched::Untouched;
pub use variation::SceneVariation;

use example::ExampleView;
use explanation::Explanation;
use search::search;
use untouched::untouched;
use variation::Effect;

/// What demonstrations mean.
#[derive(Clone, Debug, Default)]
pub struct Meaning {
    /// The shortest program that explains them all. `None` if there is none, or the search took too long.
    pub program: Option<TaskProgram>,
    /// Other programs that explain them all and act differently elsewhere, the shortest first.
    pub alternatives: Vec<Alternative>,
    /// Objects like those that were moved which were left where they are: reasons why the program does not say more.
    pub untouched: Vec<Untouched>,
}

/// A program that may have been meant, too.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// The program.
    pub program: TaskProgram,
    /// A table on which it acts differently from those before it.
    pub decided_by: SceneVariation,
}

impl Meaning {
    /// The most alternatives that are told.
    pub const MOST_ALTERNATIVES: usize = 8;

    /// What examples mean.
    pub fn of(examples: &[Example]) -> Self {
        let views: Vec<_> = examples.iter().map(Example::view).collect();
        let mut programs = search(&views).into_iter();
        let program = programs.next();
        let alternatives = program.as_ref().map(|program| {
            let others: Vec<_> = programs.collect();
            alternatives(examples, program, &others)
        });
        Self {
            program,
            alternatives: alternatives.unwrap_or_default(),
            untouched: Self::untouched_in(examples),
        }
    }

    /// The objects of examples like those that were moved which were left where they are, by their kinds.
    pub fn untouched_in(examples: &[Example]) -> Vec<Untouched> {
        let mut all = Vec::new();
        for found in examples.iter().flat_map(untouched) {
            if !all.contains(&found) {
                all.push(found);
            }
        }
        all
    }

    /// What a demonstration means, if that is more than its steps.
    pub fn beyond_steps(shown: &Demonstration, task: &Task) -> Option<Self> {
        let example = Example::of(shown, task).filter(|_| task.steps.len() > 1)?;
        let meaning = Self::of(std::slice::from_ref(&example));
        meaning.says_more_than(&example).then_some(meaning)
    }

    /// The meaning if the alternative of this number is the right one, from 1: nothing is left open. `None` if there is no such alternative.
    pub fn answered(&self, number: usize) -> Option<Self> {
        let chosen = self.alternatives.get(number.checked_sub(1)?)?;
        Some(Self {
            program: Some(chosen.program.clone()),
            alternatives: Vec::new(),
            untouched: self.untouched.clone(),
        })
    }

    /// True if the program says more than the steps of an example.
    pub fn says_more_than(&self, example: &Example) -> bool {
        let program = self.program.as_ref();
        program.is_some_and(|program| program.sentences.len() < example.deeds.len())
    }
}

/// The programs that act differently from each other on a variation of an example.
fn alternatives(
    examples: &[Example],
    program: &TaskProgram,
    others: &[TaskProgram],
) -> Vec<Alternative> {
    let variations = examples.iter().flat_map(|example| {
        let touched: Vec<_> = example.touched().into_iter().collect();
        let scene = example.tables.first();
        scene.map_or(Vec::new(), |scene| SceneVariation::all(scene, &touched))
    });
    let variations: Vec<_> = variations.collect();
    let effects = |program: &TaskProgram| -> Vec<_> {
        let variations = variations.iter();
        variations
            .map(|variation| Effect::of(program, &variation.scene))
            .collect()
    };
    let first = effects(program);
    let mut known = vec![first.clone()];
    let mut all = Vec::new();
    for other in others {
        if all.len() >= Meaning::MOST_ALTERNATIVES {
            break;
        }
        let own = effects(other);
        let mut differences = variations.iter().zip(own.iter().zip(&first));
        let differs = differences.find(|(_, (own, first))| own != first);
        if let Some((variation, _)) = differs.filter(|_| !known.contains(&own)) {
            all.push(Alternative {
                program: other.clone(),
                decided_by: variation.clone(),
            });
            known.push(own);
        }
    }
    all
}

impl TaskProgram {
    /// True if a program does what this one does on a table, up to what both leave to choice.
    pub fn acts_like(&self, other: &Self, scene: &TableScene) -> bool {
        match (
            Example::of_program(self, scene),
            Example::of_program(other, scene),
        ) {
            (Ok(own), Ok(others)) => other.explains(&own) && self.explains(&others),
            (Err(_), Err(_)) => true,
            (Ok(_), Err(_)) | (Err(_), Ok(_)) => false,
        }
    }

    /// True if an example may be the work of this program.
    pub fn explains(&self, example: &Example) -> bool {
        let view: ExampleView = example.view();
        Explanation::whole(&view, self).is_some()
    }
}
