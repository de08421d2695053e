//! Task programs, carried out in a simulation by the hand or by the robot, step by step: each is decided by the table as it then is.

mod hand;

use std::fmt;

use bevy::prelude::*;
use tabletop_controller::Sight;
use tabletop_core::{ObjectSpec, StepApp as _};
use tabletop_planner::{PlanFailure, RobotBody, imitate};
use tabletop_program::{
    Impossible, NextAttempt, ProgramAttempts, StepAttempt, TableScene, TaskProgram,
};

use crate::imitation::AppStage;

/// Who carries out a program.
#[derive(Clone, Copy, Debug)]
pub enum ProgramActor<'a> {
    /// The demonstrator's hand.
    Hand,
    /// The robot; the seed decides its random search for paths.
    Robot {
        /// Its body.
        body: &'a RobotBody,
        /// The seed.
        seed: u64,
    },
}

/// The result of carrying out a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// The steps that were done, in words.
    pub steps: Vec<String>,
    /// Number of repeated tries.
    pub corrections: usize,
    /// The reason why it was given up.
    pub failure: Option<TellFailure>,
}

/// The reason why a program was given up.
#[derive(Clone, Debug, PartialEq)]
pub enum TellFailure {
    /// Nothing that can be done leads further.
    Impossible(Impossible),
    /// A step has failed.
    Step(String, PlanFailure),
}

/// Carries out a program with these objects. `tell` is called with the number and the sentence of every step before it is tried.
pub fn carry_out(
    app: &mut App,
    program: &TaskProgram,
    objects: &[ObjectSpec],
    performer: ProgramActor,
    mut tell: impl FnMut(usize, &str),
) -> Told {
    let mut scene = table_of(app.world_mut(), objects);
    let mut attempts = ProgramAttempts::begin(program, &scene);
    let mut corrections = 0;
    let failure = loop {
        let attempt = match attempts.next_on(&scene) {
            NextAttempt::Try(attempt) => attempt,
            NextAttempt::Done => break None,
            NextAttempt::Impossible(reason) => break Some(TellFailure::Impossible(reason)),
            NextAttempt::Misplaced(StepAttempt { step, sentence, .. }) => {
                let failure = PlanFailure::Misplaced(step.object);
                break Some(TellFailure::Step(sentence, failure));
            }
        };
        tell(attempt.number, &attempt.sentence);
        let done = match performer {
            ProgramActor::Hand => hand::perform(app, &scene, &attempt.step),
            ProgramActor::Robot { body, seed } => {
                let (task, binding) = attempt.step.task(&scene);
                let seed = seed.wrapping_add((attempt.number - 1 + attempt.tries) as u64);
                let mut stage = AppStage::new(app);
                let imitation = imitate(&mut stage, body, &task, &binding, seed, |_| {});
                corrections += imitation.corrections;
                imitation
                    .failure
                    .map_or(Ok(()), |(_, failure)| Err(failure))
            }
        };
        if let Err(failure) = done {
            break Some(TellFailure::Step(attempt.sentence, failure));
        }
        app.step(ProgramAttempts::SETTLING);
        attempts.did(attempt);
        scene = table_of(app.world_mut(), objects);
    };
    Told {
        steps: attempts.steps,
        corrections: corrections + attempts.corrections,
        failure,
    }
}

/// These objects where they are now, as programs of tasks see them.
pub fn table_of(world: &mut World, objects: &[ObjectSpec]) -> TableScene {
    let sight = Sight::of(world);
    let here = objects.iter().filter_map(|object| {
        let pose = sight.objects.get(&object.id)?.pose;
        Some(ObjectSpec {
            pose,
            ..object.clone()
        })
    });
    TableScene {
        table: sight.table,
        objects: here.collect(),
        joints: sight.joints,
    }
}

impl TellFailure {
    /// Class of the failure, for a table.
    pub const fn class(&self) -> &'static str {
        match self {
            Self::Impossible(_) => "impossible",
            Self::Step(_, failure) => failure.class(),
        }
    }
}

impl fmt::Display for TellFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Impossible(reason) => write!(f, "{reason}"),
            Self::Step(sentence, failure) => {
                Impossible::sentence(sentence.clone(), failure.to_string()).fmt(f)
            }
        }
    }
}
