//! The robot's place in front of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Arm, Robot, RobotJoint, SimFact, Table};

use crate::{
    articulation::link_entities, command::joint_targets::JointTargets, gripper::grips::Grips,
    motion::view::RobotView,
};

pub(crate) fn table_has_come(tables: Query<(), Added<Table>>) -> bool {
    !tables.is_empty()
}

/// Puts the robot in front of the table, as its joints have it.
pub(crate) fn stand_at_table(world: &mut World) -> Result {
    link_entities::teleport(world)?;
    world.run_system_cached(publish)?;
    Ok(())
}

/// Writes where the arms are.
pub(crate) fn publish(known: RobotView, targets: Res<JointTargets>, mut robot: ResMut<Robot>) {
    let base = known.base();
    known.publish(&mut robot, &targets, base);
}

/// Puts the arms home that have come into the table or something else while the robot was hidden and met nothing.
pub(crate) fn leave_obstacles(
    known: RobotView,
    grips: Res<Grips>,
    mut robot: ResMut<Robot>,
    mut rapier: WriteRapierContext,
    mut facts: MessageWriter<SimFact>,
) -> Result {
    let rapier = rapier.single_mut()?;
    let mut motion = known.motion(&robot, &grips, &rapier);
    for arm in Arm::BOTH {
        let Some(obstacle) = motion.is_inside(arm) else {
            continue;
        };
        for joint in RobotJoint::of_arm(arm) {
            robot.joints[joint.index()].position = joint.home();
        }
        let by = known.name(obstacle);
        facts.write(SimFact::ArmBlocked { arm, by });
    }
    Ok(())
}
