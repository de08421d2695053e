//! The robot's presence at the table.

use bevy::prelude::*;
use tabletop_core::{CommandId, Robot, RobotFact, RobotLayout, SimFact};

use tabletop_robot::{LinkEntities, enable, spawn};

use crate::{
    gripper::grips, motion::placement::leave_obstacles, motion::placement::stand_at_table,
};

/// Puts the robot at the table, or takes it away. Its grippers first let go of everything.
pub(crate) fn show(world: &mut World, cause: CommandId, show: bool) {
    if world.resource::<Robot>().is_shown == show {
        return;
    }
    if !show {
        for limb in world.resource::<RobotLayout>().limb_ids() {
            grips::release(world, limb);
        }
    }
    world.resource_mut::<Robot>().is_shown = show;
    if world.resource::<LinkEntities>().0.is_empty()
        && let Err(error) = spawn(world)
    {
        error!("the robot has no bodies: {error}");
    }
    if let Err(error) = enable(world, show).and_then(|()| place(world, show)) {
        error!("cannot place the robot: {error}");
    }
    world.write_message(SimFact::Robot(RobotFact::Shown { cause, shown: show }));
}

/// Puts the bodies where the joints have them, if there is room.
fn place(world: &mut World, show: bool) -> Result {
    if show {
        let () = world.run_system_cached(leave_obstacles)?;
    }
    stand_at_table(world)
}
