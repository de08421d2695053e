//! Grasping and releasing objects.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    Cause, CommandId, Hand, HandCommand, HandFact, Hands, Held, IssuedCommand, Manipulator,
    ObjectIndex, ObjectSpec, Paused, SimFact, carry_out,
};
use tabletop_geometry::{Pose, turn_about};
use tabletop_history::begin_segment;
use tabletop_physics::{Carry, hold, let_go, remove_object};

use crate::rules;

/// The target pose of a held object.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct CarryTarget(pub Pose);

/// Carries out the commands to hands, one after the other.
pub(crate) fn obey(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    carry_out(world, reader, |world, cause, command| match command {
        HandCommand::Select(hand) => {
            world.resource_mut::<Hands>().selected = hand;
            Ok(())
        }
        HandCommand::Grasp { hand, object } => {
            refuse_while_paused(world)?;
            grasp(world, cause, hand, &object)
        }
        HandCommand::MoveTo { hand, location } => {
            refuse_while_paused(world)?;
            retarget(world, hand, |_| location)
        }
        HandCommand::MoveBy { hand, offset } => {
            refuse_while_paused(world)?;
            retarget(world, hand, |location| location + offset)
        }
        HandCommand::Turn {
            hand,
            axis,
            degrees,
        } => {
            refuse_while_paused(world)?;
            turn(world, hand, axis, degrees)
        }
        HandCommand::Release(hand) => {
            refuse_while_paused(world)?;
            release(world, cause, hand);
            Ok(())
        }
        HandCommand::Destroy(hand) => {
            refuse_while_paused(world)?;
            destroy(world, cause, hand)
        }
    })
}

fn refuse_while_paused(world: &World) -> Result<(), String> {
    match world.resource::<Paused>().0 {
        true => Err("hands cannot act while the simulation is paused".into()),
        false => Ok(()),
    }
}

fn grasp(world: &mut World, cause: CommandId, hand: Hand, id: &str) -> Result<(), String> {
    let index = world.resource::<ObjectIndex>();
    let Some(object) = index.get(id) else {
        return Err(format!("{hand} cannot grasp `{id}`: {}", index.lacks(id)));
    };
    let hands = world.resource::<Hands>();
    if hands.held_by(hand) == Some(object) {
        return Ok(());
    }
    let Ok(letting_go) = rules::letting_go_for(hand, hands) else {
        return Err(format!(
            "{hand} cannot grasp `{id}`: both hands are occupied"
        ));
    };
    let handing_off = hands.holder_of(object);
    for other in letting_go.into_iter().chain(handing_off) {
        release(world, cause, other);
    }

    begin_segment(world, cause);
    hold(world, object, Manipulator::Hand(hand));
    let here = world
        .get::<Transform>(object)
        .map_or(Pose::IDENTITY, Pose::from);
    world.entity_mut(object).insert(CarryTarget(here));
    world.resource_mut::<Hands>().set_held(hand, Some(object));
    world.write_message(SimFact::Hand(HandFact::Grasped {
        cause,
        hand,
        id: id.to_owned(),
    }));
    Ok(())
}

fn release(world: &mut World, cause: CommandId, hand: Hand) {
    let Some((object, id)) = held_by(world, hand) else {
        return;
    };
    begin_segment(world, cause);
    world.resource_mut::<Hands>().set_held(hand, None);
    world.entity_mut(object).remove::<CarryTarget>();
    let_go(world, object);
    let cause = Some(cause);
    world.write_message(SimFact::Hand(HandFact::Released { cause, hand, id }));
}

fn destroy(world: &mut World, cause: CommandId, hand: Hand) -> Result<(), String> {
    let Some((object, id)) = held_by(world, hand) else {
        return Err(format!("{hand} holds nothing to destroy"));
    };
    begin_segment(world, cause);
    world.resource_mut::<Hands>().set_held(hand, None);
    world.entity_mut(object).remove::<CarryTarget>();
    remove_object(world, object);
    world.write_message(SimFact::Hand(HandFact::Destroyed { cause, hand, id }));
    Ok(())
}

/// The object in a hand, and its id.
fn held_by(world: &World, hand: Hand) -> Option<(Entity, String)> {
    let object = world.resource::<Hands>().held_by(hand)?;
    Some((object, world.get::<ObjectSpec>(object)?.id.clone()))
}

fn retarget(world: &mut World, hand: Hand, to: impl FnOnce(Vec3) -> Vec3) -> Result<(), String> {
    let Some(mut target) = target_of(world, hand) else {
        return Err(format!("{hand} holds nothing to move"));
    };
    let location = to(target.0.location);
    if !location.is_finite() {
        return Err(format!("{hand} cannot move anything to {location}"));
    }
    target.0.location = location;
    Ok(())
}

fn turn(world: &mut World, hand: Hand, axis: Vec3, degrees: f32) -> Result<(), String> {
    let Some(mut target) = target_of(world, hand) else {
        return Err(format!("{hand} holds nothing to turn"));
    };
    let Some(direction) = axis.try_normalize().filter(|_| degrees.is_finite()) else {
        return Err(format!(
            "{hand} cannot turn anything by {degrees}° about {axis}"
        ));
    };
    let turn = turn_about(direction, degrees.to_radians());
    target.0.rotation = (turn * target.0.rotation).normalize();
    Ok(())
}

/// The target of a hand's object.
fn target_of(world: &mut World, hand: Hand) -> Option<Mut<'_, CarryTarget>> {
    let object = world.resource::<Hands>().held_by(hand)?;
    world.get_mut(object)
}

/// Empties a hand whose object is gone: off the edge of the world, or despawned by others.
pub(crate) fn note_lost(
    remove: On<Remove, Held>,
    objects: Query<&ObjectSpec>,
    cause: Res<Cause>,
    mut hands: ResMut<Hands>,
    mut facts: MessageWriter<SimFact>,
) {
    let Some(hand) = hands.holder_of(remove.entity) else {
        return;
    };
    hands.set_held(hand, None);
    if let Ok(spec) = objects.get(remove.entity) {
        facts.write(SimFact::Hand(HandFact::Released {
            cause: cause.0,
            hand,
            id: spec.id.clone(),
        }));
    }
}

/// Sets the target of a held object to its present pose when it is carried in a new way, because it was fastened or loosened.
pub(crate) fn note_carried_anew(
    insert: On<Insert, Carry>,
    mut held: Query<(&Transform, &mut CarryTarget)>,
) {
    if let Ok((here, mut target)) = held.get_mut(insert.entity) {
        target.0 = here.into();
    }
}
