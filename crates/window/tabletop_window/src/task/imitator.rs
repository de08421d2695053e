//! The robot that imitates while time passes in the window.

use std::time::Duration;

use bevy::prelude::*;
use tabletop_controller::{RobotController, Sight};
use tabletop_core::{
    Actor, Agent, ObjectIndex, ObjectSpec, OrderSystems, Paused, Replaying, RestApp as _,
    RestingSystems, Robot, RobotCommand, RobotLayout, Table, WriteCommand as _,
};
use tabletop_planner::{Execution, ExecutionPace, Following, Imitation, RobotBody, goal_poses};
use tabletop_robot::Description;
use tabletop_task::Task;
use tabletop_user::{Ghost, Ghosts, Imitating, Notices, Tone};

use super::understood::{Lesson, Understood};
use tabletop_real::{BodyGuard, RealRobot};

/// Time for which a tick waits for its drives.
const PATIENCE: Duration = Duration::from_millis(4);
/// Number of ticks until the robot is at the table, and objects on it are at rest.
const PREPARATION: u32 = 30;

/// The robot that imitates.
#[derive(Resource, Default)]
pub(super) struct RobotImitator(ImitatorState);

#[derive(Default)]
enum ImitatorState {
    #[default]
    Idle,
    Preparing {
        lesson: Box<Lesson>,
        ticks: u32,
    },
    /// The [`RobotController`] is an [`Execution`].
    Acting {
        task: Box<Task>,
        /// Ghosts of objects at their goals, with their steps.
        ghosts: Vec<(usize, Ghost)>,
    },
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<RobotImitator>()
        .add_systems(
            FixedUpdate,
            supervise
                .run_if(is_busy)
                .in_set(OrderSystems::User)
                .in_set(RestingSystems),
        )
        .wake_while(is_busy)
        .add_systems(Update, publish);
}

fn is_busy(imitator: Res<RobotImitator>) -> bool {
    !matches!(imitator.0, ImitatorState::Idle)
}

impl RobotImitator {
    /// Prepares the imitation.
    pub fn prepare(
        &mut self,
        understood: &Understood,
        controller: &mut RobotController,
    ) -> Result<(), String> {
        let lesson = understood.lesson();
        let lesson = lesson.ok_or("nothing was shown yet: record a demonstration first")?;
        self.stop(controller);
        self.0 = ImitatorState::Preparing {
            lesson: Box::new(lesson.clone()),
            ticks: 0,
        };
        Ok(())
    }

    pub fn stop(&mut self, controller: &mut RobotController) {
        if matches!(self.0, ImitatorState::Acting { .. }) {
            controller.stop();
        }
        self.0 = ImitatorState::Idle;
    }

    /// Its progress.
    fn progress(&self, execution: Option<&Execution>) -> Imitating {
        match &self.0 {
            ImitatorState::Idle => Imitating::Idle,
            ImitatorState::Preparing { .. } => Imitating::Preparing,
            ImitatorState::Acting { .. } => match (execution, execution.and_then(Execution::doing))
            {
                (Some(execution), Some(doing)) => Imitating::Step {
                    number: doing.step,
                    tries: doing.tries,
                    is_planning: execution.is_planning(),
                },
                _ => Imitating::Preparing,
            },
        }
    }

    /// Ghosts of the steps that are not done yet.
    fn ghosts(&self, execution: Option<&Execution>) -> Vec<Ghost> {
        let ImitatorState::Acting { ghosts, .. } = &self.0 else {
            return Vec::new();
        };
        let doing = execution.and_then(Execution::doing);
        let present = doing.map_or(1, |doing| doing.step);
        let left = ghosts.iter().filter(|(step, _)| *step >= present);
        left.map(|(step, ghost)| Ghost {
            is_next: *step == present,
            ..ghost.clone()
        })
        .collect()
    }
}

/// Publishes the robot's progress for panels and view.
fn publish(
    imitator: Res<RobotImitator>,
    controller: Res<RobotController>,
    mut imitating: ResMut<Imitating>,
    mut ghosts: ResMut<Ghosts>,
) {
    let execution = controller.get();
    imitating.set_if_neq(imitator.progress(execution));
    ghosts.set_if_neq(Ghosts(imitator.ghosts(execution)));
}

/// Prepares the imitation, begins it, and ends it when it is over, stopped, or no longer possible.
fn supervise(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let mut imitator = std::mem::take(&mut *world.resource_mut::<RobotImitator>());
    let outcome = match () {
        () if world.resource::<Replaying>().0 => Some(Err("a recording was opened".into())),
        () if world.resource::<Agent>().is_on() => Some(Err("a script was started".into())),
        () if !is_there(world) && !matches!(imitator.0, ImitatorState::Preparing { .. }) => {
            Some(Err("the robot was taken away".into()))
        }
        () => imitator.go_on(world),
    };
    let Some(outcome) = outcome else {
        *world.resource_mut::<RobotImitator>() = imitator;
        return;
    };
    world.resource_mut::<RobotController>().stop();
    let (tone, report) = match outcome {
        Ok(report) => (Tone::Event, report),
        Err(reason) => (Tone::Warning, format!("the robot has stopped: {reason}")),
    };
    world.resource_mut::<Notices>().append(tone, &report);
}

fn is_there(world: &World) -> bool {
    world.resource::<Robot>().is_shown
}

impl RobotImitator {
    /// Continues by a tick. Returns the end.
    fn go_on(&mut self, world: &mut World) -> Option<Result<String, String>> {
        match &mut self.0 {
            ImitatorState::Idle => None,
            ImitatorState::Preparing { lesson, ticks } => {
                if *ticks == 0 && !is_there(world) {
                    world.write_command_of(Actor::Panel, RobotCommand::Show(true));
                }
                *ticks += 1;
                if *ticks < PREPARATION {
                    return None;
                }
                match begin(world, lesson) {
                    Ok(acting) => {
                        self.0 = acting;
                        None
                    }
                    Err(reason) => Some(Err(reason)),
                }
            }
            ImitatorState::Acting { task, .. } => {
                let controller = world.resource::<RobotController>();
                let execution = controller.get::<Execution>()?;
                Some(reported(task, execution.result()?))
            }
        }
    }
}

/// The result in a sentence.
fn reported(task: &Task, imitation: &Imitation) -> Result<String, String> {
    match &imitation.failure {
        None => Ok("the robot has done the task".into()),
        Some((step, failure)) => {
            let sentence = task.step(*step).map_or("", |step| step.sentence.as_str());
            Err(format!("step {step} ({sentence}): {failure}"))
        }
    }
}

/// Begins with the present objects on the table.
fn begin(world: &mut World, lesson: &Lesson) -> Result<ImitatorState, String> {
    let index = world.resource::<ObjectIndex>();
    let objects: Vec<_> = index
        .iter()
        .filter_map(|object| world.get::<ObjectSpec>(object).cloned())
        .collect();
    let binding = lesson.task.bind(&lesson.requirements, &objects);
    let binding = binding.map_err(|unbound| unbound.to_string())?;
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
    let is_real = world.contains_resource::<RealRobot>();
    let body = match is_real {
        true => body.guarded(BodyGuard::GAPS),
        false => body,
    };
    let mut task = lesson.task.clone();
    task.phrase(&lesson.requirements);
    let sight = Sight::of(world);
    let shape = |id: &str| Some(objects.iter().find(|object| object.id == id)?.shape.clone());
    let ghosts = goal_poses(&task, &binding, &sight);
    let ghosts = ghosts.into_iter().filter_map(|(step, id, pose)| {
        let ghost = Ghost {
            shape: shape(&id)?,
            id,
            pose,
            is_next: false,
        };
        Some((step, ghost))
    });
    let ghosts = ghosts.collect();
    let layout = world.resource::<RobotLayout>().clone();
    let pace = ExecutionPace {
        patience: PATIENCE,
        following: match is_real {
            true => Following::MACHINE,
            false => Following::EXACT,
        },
    };
    let execution = Execution::begin(layout, body, task.clone(), binding, sight, SEED, pace);
    let execution = execution.map_err(|error| error.to_string())?;
    world.insert_resource(RobotController::new(execution));
    Ok(ImitatorState::Acting {
        task: Box::new(task),
        ghosts,
    })
}

/// Seed of random choices.
const SEED: u64 = 0;
