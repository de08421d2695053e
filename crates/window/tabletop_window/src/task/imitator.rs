//! The robot that imitates while time passes in the window.

use bevy::prelude::*;
use tabletop_controller::RobotController;
use tabletop_core::{
    Actor, Agent, OrderSystems, Paused, Replaying, RestApp as _, RestingSystems, Robot,
    RobotCommand, WriteCommand as _,
};
use tabletop_planner::Execution;
use tabletop_user::{Ghost, Ghosts, ImitatedStep, Imitating, Notices, Tone};

use super::assignment::{Assignment, BegunTask, Next};

/// Number of ticks until the robot is at the table, and objects on it are at rest.
const PREPARATION: u32 = 30;

/// The robot that imitates.
#[derive(Resource, Default)]
pub(super) struct RobotImitator(ImitatorState);

#[derive(Default)]
enum ImitatorState {
    #[default]
    Idle,
    /// What is next begins when the robot is at the table, and objects on it are at rest.
    Preparing { assignment: Assignment, ticks: u32 },
    Acting {
        assignment: Assignment,
        begun: Box<BegunTask>,
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
    /// Prepares what the robot is to do.
    pub fn prepare(&mut self, assignment: Assignment, controller: &mut RobotController) {
        self.stop(controller);
        self.0 = ImitatorState::Preparing {
            assignment,
            ticks: 0,
        };
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
            ImitatorState::Acting { assignment, begun } => {
                match (execution, execution.and_then(Execution::doing)) {
                    (Some(execution), Some(doing)) => {
                        let step = assignment.step(doing.step, &begun.task);
                        Imitating::Step(ImitatedStep {
                            tries: step.tries + doing.tries,
                            is_planning: execution.is_planning(),
                            ..step
                        })
                    }
                    _ => Imitating::Preparing,
                }
            }
        }
    }

    /// Ghosts of the steps that are not done yet.
    fn ghosts(&self, execution: Option<&Execution>) -> Vec<Ghost> {
        let ImitatorState::Acting { begun, .. } = &self.0 else {
            return Vec::new();
        };
        let doing = execution.and_then(Execution::doing);
        let present = doing.map_or(1, |doing| doing.step);
        let left = begun.ghosts.iter().filter(|(step, _)| *step >= present);
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
        match std::mem::take(&mut self.0) {
            ImitatorState::Idle => None,
            ImitatorState::Preparing { assignment, ticks } => {
                if ticks == 0 && !is_there(world) {
                    world.write_command_of(Actor::Panel, RobotCommand::Show(true));
                }
                let ticks = ticks + 1;
                match ticks < PREPARATION {
                    true => {
                        self.0 = ImitatorState::Preparing { assignment, ticks };
                        None
                    }
                    false => self.begin(assignment, world),
                }
            }
            ImitatorState::Acting { assignment, begun } => {
                self.go_on_with(assignment, begun, world)
            }
        }
    }

    fn begin(
        &mut self,
        mut assignment: Assignment,
        world: &mut World,
    ) -> Option<Result<String, String>> {
        match assignment.begin(world) {
            Ok(Next::Begun(begun)) => {
                let begun = Box::new(begun);
                self.0 = ImitatorState::Acting { assignment, begun };
                None
            }
            Ok(Next::Done(report)) => Some(Ok(report)),
            Err(reason) => Some(Err(reason)),
        }
    }

    fn go_on_with(
        &mut self,
        mut assignment: Assignment,
        begun: Box<BegunTask>,
        world: &World,
    ) -> Option<Result<String, String>> {
        let execution = world.resource::<RobotController>().get::<Execution>();
        let Some(result) = execution.and_then(Execution::result) else {
            self.0 = ImitatorState::Acting { assignment, begun };
            return None;
        };
        if let Some((number, failure)) = &result.failure {
            let step = assignment.step(*number, &begun.task);
            let ImitatedStep {
                number, sentence, ..
            } = step;
            return Some(Err(format!("step {number} ({sentence}): {failure}")));
        }
        let report = assignment.did();
        if report.is_none() {
            self.0 = ImitatorState::Preparing {
                assignment,
                ticks: 0,
            };
        }
        report.map(Ok)
    }
}
