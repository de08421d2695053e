//! The robot's assignment: a demonstrated task, or the program that demonstrations mean, step by step.

use std::time::Duration;

use bevy::prelude::*;
use tabletop_controller::Sight;
use tabletop_core::{ObjectIndex, ObjectSpec, Table};
use tabletop_episodes::telling::{TellFailure, table_of};
use tabletop_planner::{PlanFailure, RobotBody, goal_poses};
use tabletop_program::{NextAttempt, ProgramAttempts, StepAttempt, TaskProgram};
use tabletop_real::execute;
use tabletop_robot::Description;
use tabletop_task::{Binding, Task};
use tabletop_user::{Ghost, ImitatedStep};

use super::{
    teaching::Teaching,
    understood::{Lesson, Understood},
};

/// Time for which a tick waits for its drives.
const PATIENCE: Duration = Duration::from_millis(4);
/// Seed of random choices.
const SEED: u64 = 0;

/// What the robot is to do.
pub(super) enum Assignment {
    Lesson(Box<Lesson>),
    Program(Box<ProgramAssignment>),
}

/// A program that the robot does.
pub(super) struct ProgramAssignment {
    program: TaskProgram,
    /// Its steps so far; `None` before the first one.
    attempts: Option<ProgramAttempts>,
    /// The step that is tried.
    attempt: Option<StepAttempt>,
}

/// What the robot does now: the [`RobotController`](tabletop_controller::RobotController) is an [`Execution`](tabletop_planner::Execution) of this task.
pub(super) struct BegunTask {
    pub task: Task,
    /// Ghosts of objects at their goals, with their steps.
    pub ghosts: Vec<(usize, Ghost)>,
}

/// What follows in an assignment.
pub(super) enum Next {
    Begun(BegunTask),
    /// It is done: the sentence that says so.
    Done(String),
}

impl Assignment {
    /// The task that the last recording shows.
    pub fn of_lesson(understood: &Understood) -> Result<Self, String> {
        let lesson = understood.lesson();
        let lesson = lesson.ok_or("nothing was shown yet: record a demonstration first")?;
        Ok(Self::Lesson(Box::new(lesson.clone())))
    }

    /// The program that the last demonstrations mean.
    pub fn of_program(teaching: &Teaching) -> Result<Self, String> {
        let program = teaching.program();
        let program = program.ok_or("no program is known yet: record a demonstration first")?;
        Ok(Self::Program(Box::new(ProgramAssignment {
            program: program.clone(),
            attempts: None,
            attempt: None,
        })))
    }

    /// Begins what comes next with the present objects on the table.
    pub fn begin(&mut self, world: &mut World) -> Result<Next, String> {
        let objects = objects(world);
        match self {
            Self::Lesson(lesson) => {
                let binding = lesson.task.bind(&lesson.requirements, &objects);
                let binding = binding.map_err(|unbound| unbound.to_string())?;
                let mut task = lesson.task.clone();
                task.phrase(&lesson.requirements);
                begun(world, task, binding, SEED).map(Next::Begun)
            }
            Self::Program(program) => program.begin(world, &objects),
        }
    }

    /// Takes in that what was begun is done. Returns the sentence that says so if nothing follows.
    pub fn did(&mut self) -> Option<String> {
        match self {
            Self::Lesson(_) => Some("the robot has done the task".into()),
            Self::Program(program) => {
                program.did();
                None
            }
        }
    }

    /// The step of this number of the task that is done.
    pub fn step(&self, number: usize, task: &Task) -> ImitatedStep {
        match self {
            Self::Lesson(_) => ImitatedStep {
                number,
                of: Some(task.steps.len()),
                sentence: task
                    .step(number)
                    .map_or_else(String::new, |step| step.sentence.clone()),
                ..default()
            },
            Self::Program(program) => program.step(),
        }
    }
}

impl ProgramAssignment {
    fn begin(&mut self, world: &mut World, objects: &[ObjectSpec]) -> Result<Next, String> {
        let scene = table_of(world, objects);
        let attempts = self
            .attempts
            .get_or_insert_with(|| ProgramAttempts::begin(&self.program, &scene));
        let attempt = match attempts.next_on(&scene) {
            NextAttempt::Try(attempt) => attempt,
            NextAttempt::Done => return Ok(Next::Done("the robot has done the program".into())),
            NextAttempt::Impossible(reason) => return Err(reason.to_string()),
            NextAttempt::Misplaced(StepAttempt { step, sentence, .. }) => {
                let failure = PlanFailure::Misplaced(step.object);
                return Err(TellFailure::Step(sentence, failure).to_string());
            }
        };
        let (task, binding) = attempt.step.task(&scene);
        let seed = SEED + (attempt.number + attempt.tries) as u64;
        self.attempt = Some(attempt);
        begun(world, task, binding, seed).map(Next::Begun)
    }

    fn did(&mut self) {
        if let (Some(attempts), Some(attempt)) = (&mut self.attempts, self.attempt.take()) {
            attempts.did(attempt);
        }
    }

    fn step(&self) -> ImitatedStep {
        let attempt = self.attempt.as_ref();
        attempt.map_or_else(ImitatedStep::default, |attempt| ImitatedStep {
            number: attempt.number,
            sentence: attempt.sentence.clone(),
            tries: attempt.tries,
            ..default()
        })
    }
}

/// The present objects on the table.
fn objects(world: &World) -> Vec<ObjectSpec> {
    let index = world.resource::<ObjectIndex>().iter();
    let objects = index.filter_map(|object| world.get::<ObjectSpec>(object).cloned());
    objects.collect()
}

/// Lets the robot do a task with these objects.
fn begun(world: &mut World, task: Task, binding: Binding, seed: u64) -> Result<BegunTask, String> {
    let table = world.query::<&Table>().iter(world).next().copied();
    let description = world
        .get_resource::<Description>()
        .ok_or("there is no robot")?;
    let body = RobotBody::new(
        &description.layout,
        description.model.clone(),
        &table.unwrap_or_default(),
    );
    let body = body.map_err(|error| error.to_string())?;
    let sight = Sight::of(world);
    let ghosts = goal_poses(&task, &binding, &sight);
    let ghosts = ghosts.into_iter().filter_map(|(step, id, pose)| {
        let ghost = Ghost {
            shape: sight.objects.get(&id)?.shape.clone(),
            id,
            pose,
            is_next: false,
        };
        Some((step, ghost))
    });
    let ghosts = ghosts.collect();
    let begun = execute(world, body, task.clone(), binding, seed, PATIENCE);
    begun.map_err(|error| error.to_string())?;
    Ok(BegunTask { task, ghosts })
}
