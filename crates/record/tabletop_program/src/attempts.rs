//! The attempts at a program: its steps as they are tried on the table, each until it leads where it should.

use std::collections::BTreeSet;

use tabletop_task::Relation;

use crate::{
    program::TaskProgram,
    run::{Impossible, NextStep, ProgramRun},
    scene::TableScene,
    step::ConcreteStep,
};

/// Number of times that the same step may come one after the other.
const TRIES: usize = 3;

/// A program that is carried out: its steps, and how often they were tried.
#[derive(Clone, Debug)]
pub struct ProgramAttempts {
    run: ProgramRun,
    /// The last step, and how often it was tried before.
    last: Option<(ConcreteStep, usize)>,
    /// The objects that were removed. A robot can only lay them aside; they are out of play all the same.
    removed: BTreeSet<String>,
    /// The steps that were done, in words.
    pub steps: Vec<String>,
    /// Number of repeated tries.
    pub corrections: usize,
}

/// A step that is to be tried.
#[derive(Clone, Debug, PartialEq)]
pub struct StepAttempt {
    /// The step.
    pub step: ConcreteStep,
    /// It in words.
    pub sentence: String,
    /// Its number, from 1.
    pub number: usize,
    /// How often it was tried before.
    pub tries: usize,
}

/// What is to be tried next.
#[derive(Clone, Debug, PartialEq)]
pub enum NextAttempt {
    /// This step.
    Try(StepAttempt),
    /// There is nothing left to do.
    Done,
    /// It cannot be done.
    Impossible(Impossible),
    /// This step was tried too often: its object never came where it belongs.
    Misplaced(StepAttempt),
}

impl ProgramAttempts {
    /// Number of ticks after a step after which what was put down is at rest.
    pub const SETTLING: u64 = 30;

    /// A program that begins on this table.
    pub fn begin(program: &TaskProgram, scene: &TableScene) -> Self {
        Self {
            run: ProgramRun::begin(program, scene),
            last: None,
            removed: BTreeSet::new(),
            steps: Vec::new(),
            corrections: 0,
        }
    }

    /// What is to be tried on the table as it is now.
    pub fn next_on(&mut self, scene: &TableScene) -> NextAttempt {
        let scene = &self.in_play(scene);
        let step = match self.run.next_on(scene) {
            NextStep::Step(step) => step,
            NextStep::Done => return NextAttempt::Done,
            NextStep::Impossible(reason) => return NextAttempt::Impossible(reason),
        };
        let is_same =
            |last: &ConcreteStep| last.object == step.object && last.relation == step.relation;
        let last = self.last.as_ref().filter(|(last, _)| is_same(last));
        let attempt = StepAttempt {
            sentence: step.sentence(scene),
            number: self.steps.len() + 1,
            tries: last.map_or(0, |(_, tries)| tries + 1),
            step,
        };
        if attempt.tries >= TRIES {
            return NextAttempt::Misplaced(attempt);
        }
        self.corrections += usize::from(attempt.tries > 0);
        NextAttempt::Try(attempt)
    }

    /// The table without what was removed.
    fn in_play(&self, scene: &TableScene) -> TableScene {
        let mut scene = scene.clone();
        let removed = &self.removed;
        scene.objects.retain(|object| !removed.contains(&object.id));
        scene
            .joints
            .retain(|joint| joint.objects.iter().all(|id| !removed.contains(id)));
        scene
    }

    /// Takes in that a step was done, as far as its hand or robot can tell.
    pub fn did(&mut self, attempt: StepAttempt) {
        if attempt.tries == 0 {
            self.steps.push(attempt.sentence);
        }
        if attempt.step.relation == Relation::Destroyed {
            self.removed.insert(attempt.step.object.clone());
        }
        self.last = Some((attempt.step, attempt.tries));
    }
}
