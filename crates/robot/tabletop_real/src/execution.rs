//! Tasks that a robot does tick by tick, be it simulated or real.

use std::{io, time::Duration};

use bevy::prelude::World;
use tabletop_controller::{RobotController, Sight};
use tabletop_core::RobotLayout;
use tabletop_planner::{Execution, ExecutionPace, Following, RobotBody};
use tabletop_task::{Binding, Task};

use crate::{body_guard::BodyGuard, robot::RealRobot};

/// Lets the robot of a world do a task from now on: its [`RobotController`] becomes an [`Execution`]. A real robot keeps its distance from everything, and follows
/// its orders as a machine can. A tick waits for its orders for as long as `patience`; `seed` decides all random trials.
///
/// # Errors
/// There is no thread in which it could be planned.
pub fn execute(
    world: &mut World,
    body: RobotBody,
    task: Task,
    binding: Binding,
    seed: u64,
    patience: Duration,
) -> io::Result<()> {
    let (body, following) = match world.contains_resource::<RealRobot>() {
        true => (body.guarded(BodyGuard::GAPS), Following::MACHINE),
        false => (body, Following::EXACT),
    };
    let pace = ExecutionPace {
        patience,
        following,
    };
    let layout = world.resource::<RobotLayout>().clone();
    let sight = Sight::of(world);
    let execution = Execution::begin(layout, body, task, binding, sight, seed, pace)?;
    world.insert_resource(RobotController::new(execution));
    Ok(())
}
