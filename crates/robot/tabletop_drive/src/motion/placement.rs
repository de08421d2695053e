//! The robot's place in front of the table.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Robot, RobotFact, SimFact, Table};

use tabletop_robot::{LinkEntities, PassiveLinks, make_passive, teleport};

use crate::{command::joint_targets::JointTargets, gripper::grips::Grips, motion::view::RobotView};

/// Whether a table has come at which the robot does not stand yet.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct NewTable(bool);

pub(crate) fn note_table(_: On<Add, Table>, mut table: ResMut<NewTable>) {
    table.0 = true;
}

pub(crate) fn table_has_come(table: Res<NewTable>) -> bool {
    table.0
}

/// Puts the robot in front of the table, with its present joint positions.
pub(crate) fn stand_at_table(world: &mut World) -> Result {
    world.insert_resource(NewTable(false));
    teleport(world)?;
    let is_shown = world.resource::<Robot>().is_shown;
    let links = world.resource::<LinkEntities>().0.len();
    let newcomer = PassiveLinks::of_newcomer(if is_shown { links } else { 0 });
    make_passive(world, newcomer)?;
    world.run_system_cached(publish)?;
    Ok(())
}

/// True while links stand in objects, or press on some.
pub(crate) fn meets_objects(passive: Res<PassiveLinks>, robot: Res<Robot>) -> bool {
    passive.are_inside() || robot.contacts.iter().any(|contact| contact.impulse > 0.0)
}

/// Lets links push nothing while they stand in objects, and from when they crush one on.
pub(crate) fn pass_through_objects(
    known: RobotView,
    grips: Res<Grips>,
    robot: Res<Robot>,
    mut rapier: WriteRapierContext,
    mut passive: ResMut<PassiveLinks>,
) -> Result {
    let mut rapier = rapier.single_mut()?;
    let posture = known.posture(&robot, None);
    let mut motion = known.motion(&robot, &grips, &rapier, posture);
    let here = motion.here();
    let bodies = &known.articulation.bodies;
    let crushing: Vec<_> = robot
        .contacts
        .iter()
        .filter(|contact| contact.impulse > 0.0 && motion.environment.is_crushed(contact.thing))
        .map(|contact| &contact.body)
        .collect();
    let now = passive.after_tick(
        bodies.len(),
        |number| motion.is_inside_object(number, &here),
        |number| crushing.contains(&&bodies[number].id),
    );
    if *passive != now {
        passive.set(now, &known.parts.0, &mut rapier.colliders);
    }
    Ok(())
}

/// Writes the state of the limbs.
pub(crate) fn publish(known: RobotView, targets: Res<JointTargets>, mut robot: ResMut<Robot>) {
    let posture = known.posture(&robot, None);
    known.publish(&mut robot, &targets, &posture);
}

/// Sends arms home that have come into the table or something else while the robot was hidden and met nothing.
pub(crate) fn leave_obstacles(
    known: RobotView,
    grips: Res<Grips>,
    mut robot: ResMut<Robot>,
    mut rapier: WriteRapierContext,
    mut facts: MessageWriter<SimFact>,
) {
    if robot.is_mirror {
        // A real robot is where it is.
        return;
    }
    let Ok(rapier) = rapier.single_mut() else {
        return;
    };
    let posture = known.posture(&robot, None);
    let mut motion = known.motion(&robot, &grips, &rapier, posture);
    for limb in known.articulation.layout.limb_ids() {
        let Some(obstacle) = motion.is_inside(limb) else {
            continue;
        };
        let layout = &known.articulation.layout;
        for joint in &layout.limb(limb).joints {
            robot.joints[joint.index()].position = layout.joint(*joint).home;
        }
        let by = known.obstacle(obstacle);
        facts.write(SimFact::Robot(RobotFact::ArmBlocked {
            arm: layout.limb(limb).name,
            by,
        }));
    }
}
