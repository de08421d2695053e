//! Taking objects into hands and letting go of them.

use bevy::{ecs::system::SystemState, prelude::*};
use bevy_rapier3d::prelude::*;
use tabletop_core::{
    Hand, Hands, Held, Joint, ObjectIndex, ObjectSpec, Paused, Pose, SimCommand, SimFact,
};
use tabletop_history::begin_segment;
use tabletop_physics::{JustReleased, hold, let_go, remove_object};

use crate::rules;

/// Where a held object is to be.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct CarryTarget(pub Pose);

/// How a held object is carried.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carry {
    /// Moved exactly to its target, as far as nothing immovable is in the way.
    Freely,
    /// Drawn towards its target, as far as its joints let it.
    AgainstJoints,
}

/// Carries out the commands to hands, one after the other.
pub(crate) fn obey(
    world: &mut World,
    reader: &mut SystemState<MessageReader<SimCommand>>,
) -> Result {
    let commands = SimCommand::unread(world, reader, |command| {
        is_for_hands(command) || matches!(command, SimCommand::SelectHand(_))
    })?;
    let is_paused = world.resource::<Paused>().0;
    for command in commands {
        if is_paused && is_for_hands(&command) {
            refuse(
                world,
                "hands cannot act while the simulation is paused".into(),
            );
            continue;
        }
        match command {
            SimCommand::SelectHand(hand) => world.resource_mut::<Hands>().selected = hand,
            SimCommand::Grasp { hand, object } => grasp(world, hand, &object),
            SimCommand::MoveTo { hand, location } => {
                retarget(world, hand, location, |_, location| location);
            }
            SimCommand::MoveBy { hand, offset } => {
                retarget(world, hand, offset, |location, offset| location + offset);
            }
            SimCommand::Turn {
                hand,
                axis,
                degrees,
            } => turn(world, hand, axis, degrees),
            SimCommand::Release(hand) => release(world, hand),
            SimCommand::Destroy(hand) => destroy(world, hand),
            _ => {}
        }
    }
    Ok(())
}

/// Whether a command makes a hand act.
fn is_for_hands(command: &SimCommand) -> bool {
    matches!(
        command,
        SimCommand::Grasp { .. }
            | SimCommand::MoveTo { .. }
            | SimCommand::MoveBy { .. }
            | SimCommand::Turn { .. }
            | SimCommand::Release(_)
            | SimCommand::Destroy(_)
    )
}

fn grasp(world: &mut World, hand: Hand, id: &str) {
    let Some(object) = world.resource::<ObjectIndex>().get(id) else {
        refuse(
            world,
            format!("{hand} cannot grasp `{id}`: there is no such object"),
        );
        return;
    };
    let hands = world.resource::<Hands>();
    if hands.held_by(hand) == Some(object) {
        return;
    }
    let Ok(letting_go) = rules::letting_go_for(hand, hands) else {
        refuse(
            world,
            format!("{hand} cannot grasp `{id}`: both hands are occupied"),
        );
        return;
    };
    let handing_off = hands.holder_of(object);
    for other in letting_go.into_iter().chain(handing_off) {
        release(world, other);
    }

    begin_segment(world);
    let is_jointed = world
        .query::<&Joint>()
        .iter(world)
        .any(|joint| joint.objects.contains(&object));
    let is_fixed = world
        .get::<ObjectSpec>(object)
        .is_some_and(ObjectSpec::is_fixed);
    let here = world
        .get::<Transform>(object)
        .map_or(Pose::IDENTITY, Pose::from);
    let mut body = world.entity_mut(object);
    body.insert((Held { by: hand }, CarryTarget(here)));
    if is_jointed && !is_fixed {
        body.insert((Carry::AgainstJoints, GravityScale(0.0)));
        body.remove::<JustReleased>();
    } else {
        body.insert(Carry::Freely);
        hold(body);
    }
    world.resource_mut::<Hands>().set_held(hand, Some(object));
    world.write_message(SimFact::Grasped {
        hand,
        id: id.to_owned(),
    });
}

fn release(world: &mut World, hand: Hand) {
    let Some((object, id)) = held_by(world, hand) else {
        return;
    };
    begin_segment(world);
    world.resource_mut::<Hands>().set_held(hand, None);
    let mut body = world.entity_mut(object);
    body.remove::<(Held, CarryTarget, Carry)>();
    let_go(body);
    world.write_message(SimFact::Released { hand, id });
}

fn destroy(world: &mut World, hand: Hand) {
    let Some((object, id)) = held_by(world, hand) else {
        refuse(world, format!("{hand} holds nothing that it could destroy"));
        return;
    };
    begin_segment(world);
    world.resource_mut::<Hands>().set_held(hand, None);
    world
        .entity_mut(object)
        .remove::<(Held, CarryTarget, Carry)>();
    remove_object(world, object);
    world.write_message(SimFact::Destroyed { hand, id });
}

/// What a hand holds, and its id.
fn held_by(world: &World, hand: Hand) -> Option<(Entity, String)> {
    let object = world.resource::<Hands>().held_by(hand)?;
    Some((object, world.get::<ObjectSpec>(object)?.id.clone()))
}

fn retarget(world: &mut World, hand: Hand, by: Vec3, change: impl FnOnce(Vec3, Vec3) -> Vec3) {
    let target = world
        .resource::<Hands>()
        .held_by(hand)
        .and_then(|object| world.get_mut::<CarryTarget>(object));
    let Some(mut target) = target else {
        refuse(world, format!("{hand} holds nothing that it could move"));
        return;
    };
    let location = change(target.0.location, by);
    if location.is_finite() {
        target.0.location = location;
    } else {
        refuse(world, format!("{hand} cannot move anything to {location}"));
    }
}

fn turn(world: &mut World, hand: Hand, axis: Vec3, degrees: f32) {
    let target = world
        .resource::<Hands>()
        .held_by(hand)
        .and_then(|object| world.get_mut::<CarryTarget>(object));
    let Some(mut target) = target else {
        refuse(world, format!("{hand} holds nothing that it could turn"));
        return;
    };
    match axis.try_normalize() {
        Some(axis) if degrees.is_finite() => {
            let turn = Quat::from_axis_angle(axis, degrees.to_radians());
            target.0.rotation = (turn * target.0.rotation).normalize();
        }
        _ => refuse(
            world,
            format!("{hand} cannot turn anything by {degrees}° about {axis}"),
        ),
    }
}

fn refuse(world: &mut World, reason: String) {
    world.write_message(SimFact::Refused { reason });
}

/// A hand whose object goes without it (off the edge of the world, or despawned by someone) is empty.
pub(crate) fn note_lost(
    remove: On<Remove, Held>,
    objects: Query<&ObjectSpec>,
    mut hands: ResMut<Hands>,
    mut facts: MessageWriter<SimFact>,
) {
    let Some(hand) = hands.holder_of(remove.entity) else {
        return;
    };
    hands.set_held(hand, None);
    if let Ok(spec) = objects.get(remove.entity) {
        facts.write(SimFact::Released {
            hand,
            id: spec.id.clone(),
        });
    }
}
