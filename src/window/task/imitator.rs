//! The robot that imitates while time passes in the window.

use std::time::Duration;

use bevy::prelude::*;
use tabletop_core::{
    Actor, Agent, ObjectIndex, ObjectSpec, OrderSystems, Paused, Replaying, RestApp as _,
    RestingSystems, Robot, RobotCommand, RobotLayout, SimBlocked, Table, WriteCommand as _,
};
use tabletop_gui::{Notices, Tone};
use tabletop_planner::{Execution, ExecutionTurn, Imitation, RobotBody, goal_poses};
use tabletop_robot::Description;
use tabletop_task::Task;
use tabletop_user::{Ghost, Ghosts, Imitating};

use super::understood::{Lesson, Understood};
use crate::imitation::{command, sight};

/// Time for which a tick waits for its orders.
const LONGEST_WAIT: Duration = Duration::from_millis(4);
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
    Acting {
        execution: Box<Execution>,
        task: Box<Task>,
        /// Ghosts of objects at their goals, with their steps.
        ghosts: Vec<(usize, Ghost)>,
        /// True while it waits for the result of the tick.
        is_expecting: bool,
        is_planning: bool,
    },
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<RobotImitator>()
        .add_systems(
            FixedUpdate,
            act.run_if(SimBlocked::is_clear)
                .run_if(is_busy)
                .in_set(OrderSystems::User)
                .in_set(RestingSystems),
        )
        .wake_while(is_busy)
        .add_systems(Update, publish.run_if(resource_changed::<RobotImitator>));
}

fn is_busy(imitator: Res<RobotImitator>) -> bool {
    !matches!(imitator.0, ImitatorState::Idle)
}

impl RobotImitator {
    /// Prepares the imitation.
    pub fn prepare(&mut self, understood: &Understood) -> Result<(), String> {
        let lesson = understood.lesson();
        let lesson = lesson.ok_or("nothing was shown yet: record a demonstration first")?;
        self.0 = ImitatorState::Preparing {
            lesson: Box::new(lesson.clone()),
            ticks: 0,
        };
        Ok(())
    }

    pub fn stop(&mut self) {
        self.0 = ImitatorState::Idle;
    }

    /// Its progress.
    fn progress(&self) -> Imitating {
        match &self.0 {
            ImitatorState::Idle => Imitating::Idle,
            ImitatorState::Preparing { .. } => Imitating::Preparing,
            ImitatorState::Acting {
                execution,
                is_planning,
                ..
            } => match execution.doing() {
                None => Imitating::Preparing,
                Some(doing) => Imitating::Step {
                    number: doing.step,
                    tries: doing.tries,
                    is_planning: *is_planning,
                },
            },
        }
    }

    /// Ghosts of the steps that are not done yet.
    fn ghosts(&self) -> Vec<Ghost> {
        let ImitatorState::Acting {
            execution, ghosts, ..
        } = &self.0
        else {
            return Vec::new();
        };
        let present = execution.doing().map_or(1, |doing| doing.step);
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
    mut imitating: ResMut<Imitating>,
    mut ghosts: ResMut<Ghosts>,
) {
    imitating.set_if_neq(imitator.progress());
    ghosts.set_if_neq(Ghosts(imitator.ghosts()));
}

/// Gives the robot its orders, once a tick.
fn act(world: &mut World) {
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
    match outcome {
        None => *world.resource_mut::<RobotImitator>() = imitator,
        Some(Ok(reported)) => world
            .resource_mut::<Notices>()
            .append(Tone::Event, &reported),
        Some(Err(reason)) => {
            let reported = format!("the robot has stopped: {reason}");
            world
                .resource_mut::<Notices>()
                .append(Tone::Warning, &reported);
        }
    }
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
            ImitatorState::Acting {
                execution,
                task,
                is_expecting,
                is_planning,
                ..
            } => {
                if *is_expecting {
                    execution.see(sight(world));
                    *is_expecting = false;
                }
                let turn = execution.turn(LONGEST_WAIT);
                *is_planning = turn == ExecutionTurn::Planning;
                match turn {
                    ExecutionTurn::Planning => None,
                    ExecutionTurn::Orders(orders) => {
                        *is_expecting = true;
                        let command = command(world.resource::<RobotLayout>(), &orders);
                        if let Some(command) = command {
                            world.write_command_of(Actor::Panel, command);
                        }
                        None
                    }
                    ExecutionTurn::Over(imitation) => Some(reported(task, &imitation)),
                }
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
    let mut task = lesson.task.clone();
    task.phrase(&lesson.requirements);
    let sight = sight(world);
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
    let execution = Execution::begin(body, task.clone(), binding, sight, SEED);
    let execution = execution.map_err(|error| error.to_string())?;
    Ok(ImitatorState::Acting {
        execution: Box::new(execution),
        task: Box::new(task),
        ghosts,
        is_expecting: false,
        is_planning: true,
    })
}

/// Seed of random choices.
const SEED: u64 = 0;
