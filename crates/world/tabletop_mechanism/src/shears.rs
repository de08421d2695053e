//! Scissors cut chains, whoever closes them.

use bevy::prelude::*;
use tabletop_core::{
    Cause, CommandId, Hand, Held, Joint, JointKind, Manipulator, MechanismFact, ObjectIndex,
    ObjectSpec, Operator, Paused, Robot, RobotLayout, Shape, SimFact, SimTick,
};
use tabletop_geometry::Pose;
use tabletop_history::begin_segment;
use tabletop_physics::{is_touching, pressures_on, push, remove_object};

use crate::limb::limb_of;

/// Distance, in units, below which an object touches a blade.
const TOUCH: f32 = 0.02;

/// How fast a hand closes scissors, in rad/s: against their spring, in a tenth of a second.
const SWING: f32 = 15.0;

/// For how many ticks it is the hand that closes them.
const SWING_TICKS: u64 = 30;

/// A hand closes scissors; a part of their joint.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Snip {
    cause: CommandId,
    hand: Hand,
    until: SimTick,
}

/// Run condition: there are scissors.
pub(crate) fn are_there(joints: Query<&Joint>) -> bool {
    joints.iter().any(is_shears)
}

const fn is_shears(joint: &Joint) -> bool {
    matches!(joint.kind, JointKind::Shears { .. })
}

/// Lets a hand close the scissors that an object is a blade of.
pub(crate) fn cut(
    world: &mut World,
    cause: CommandId,
    hand: Hand,
    blade: &str,
) -> Result<(), String> {
    let index = world.resource::<ObjectIndex>();
    let object = index
        .get(blade)
        .ok_or_else(|| format!("{hand} cannot cut with `{blade}`: {}", index.lacks(blade)))?;
    let mut joints = world.query::<(Entity, &Joint)>();
    let (entity, shears) = joints
        .iter(world)
        .find(|(_, joint)| is_shears(joint) && joint.objects.contains(&object))
        .map(|(entity, joint)| (entity, *joint))
        .ok_or_else(|| format!("{hand} cannot cut with `{blade}`: it is not a pair of scissors"))?;
    begin_segment(world, cause);
    swing_shut(world, shears);
    let until = SimTick(world.resource::<SimTick>().0 + SWING_TICKS);
    world.entity_mut(entity).insert(Snip { cause, hand, until });
    Ok(())
}

/// Lets the blades that nobody holds swing towards each other, or towards the one that is held.
fn swing_shut(world: &mut World, shears: Joint) {
    let is_free = |blade| world.get::<Held>(blade).is_none();
    let free = shears.objects.map(is_free);
    let swing = SWING / free.iter().filter(|&&is_free| is_free).count().max(1) as f32;
    for index in [0, 1] {
        let blade = shears.objects[index];
        let place = world.get::<Transform>(blade).map(Pose::from);
        let Some(place) = place.filter(|_| free[index]) else {
            continue;
        };
        let hinge = place * shears.frames[index];
        // The second blade closes against its axis, the first along it.
        let turn = hinge.rotation * Vec3::X * [swing, -swing][index];
        push(
            world,
            blade,
            turn.cross(place.location - hinge.location),
            turn,
        );
    }
}

/// Removes the links of chains that both blades of scissors touch.
pub(crate) fn cut_links(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let mut joints = world.query::<(Entity, &Joint)>();
    let shears: Vec<_> = joints
        .iter(world)
        .filter(|(_, joint)| is_shears(joint))
        .map(|(entity, joint)| (entity, *joint))
        .collect();
    let objects = world.resource::<ObjectIndex>().iter();
    let links: Vec<_> = objects
        .filter_map(|object| {
            let spec = world.get::<ObjectSpec>(object)?;
            let pose = world.get::<Transform>(object).map(Pose::from)?;
            let is_link = matches!(spec.shape, Shape::Link { .. });
            is_link.then(|| (object, spec.id.clone(), spec.shape.clone(), pose))
        })
        .collect();
    for (object, link, shape, pose) in links {
        let bounds = shape.bounds(pose);
        let touches = |world: &mut World, blade: Entity| {
            let room = world.get::<ObjectSpec>(blade).and_then(|spec| {
                let pose = world.get::<Transform>(blade).map(Pose::from)?;
                Some(spec.shape.bounds(pose))
            });
            room.is_some_and(|room| room.overlaps(bounds, -TOUCH))
                && is_touching(world, blade, &shape, pose, TOUCH)
        };
        let cutting = shears
            .iter()
            .find(|(_, joint)| joint.objects.iter().all(|&blade| touches(world, blade)));
        if let Some(&(entity, joint)) = cutting {
            let (cause, by) = who_closes(world, entity, joint);
            let blade = world.get::<ObjectSpec>(joint.objects[0]);
            let blade = blade.map_or_else(String::new, |blade| blade.id.clone());
            world.write_message(SimFact::Mechanism(MechanismFact::Cut {
                cause,
                by,
                blade,
                link,
            }));
            *world.resource_mut() = Cause(cause);
            remove_object(world, object);
            *world.resource_mut() = Cause(None);
        }
    }
}

/// Who closes scissors, and the command that caused it: the hand that cuts, the holder of a blade, a limb that touches one, or the object
/// that presses hardest on one.
fn who_closes(world: &mut World, entity: Entity, joint: Joint) -> (Option<CommandId>, Operator) {
    let tick = *world.resource::<SimTick>();
    if let Some(closing) = world.get::<Snip>(entity).filter(|it| tick <= it.until) {
        return (Some(closing.cause), Operator::Hand(closing.hand));
    }
    let held = |blade: &Entity| world.get::<Held>(*blade).map(|held| held.by);
    match joint.objects.iter().find_map(held) {
        Some(Manipulator::Hand(hand)) => return (None, Operator::Hand(hand)),
        Some(Manipulator::Gripper(limb)) => return (None, Operator::Limb(limb)),
        None => {}
    }
    let layout = world.resource::<RobotLayout>();
    let mut contacts = world.resource::<Robot>().contacts.iter();
    let limb = contacts.find_map(|contact| {
        let is_blade = joint.objects.contains(&contact.thing);
        limb_of(layout, &contact.body).filter(|_| is_blade)
    });
    if let Some(limb) = limb {
        return (None, Operator::Limb(limb));
    }
    let mut hardest = (0.0, joint.objects[0]);
    for pressure in pressures_on(world, &joint.objects) {
        let object = world.get::<ObjectSpec>(pressure.by);
        let is_link = object.is_some_and(|object| matches!(object.shape, Shape::Link { .. }));
        if object.is_some() && !is_link && pressure.force > hardest.0 {
            hardest = (pressure.force, pressure.by);
        }
    }
    let object = world.get::<ObjectSpec>(hardest.1);
    let id = object.map_or_else(String::new, |object| object.id.clone());
    (None, Operator::Object(id))
}
