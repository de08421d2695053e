//! Execution of the commands to mechanisms.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    CommandId, ControlKind, Hand, IssuedCommand, MechanismCommand, MechanismFact, ObjectIndex,
    ObjectSpec, Operator, Paused, SimFact, Turn, carry_out,
};
use tabletop_history::begin_segment;

use crate::{bonds, button, network::Network, shears};

/// Carries out the commands, one after the other.
pub(crate) fn obey(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    carry_out(world, reader, |world, cause, command| {
        if world.resource::<Paused>().0 {
            return Err("hands cannot act while the simulation is paused".into());
        }
        match command {
            MechanismCommand::Trigger {
                hand,
                control,
                part,
            } => {
                let next = next_state(world, &control, part)?;
                begin_segment(world, cause);
                trigger(world, Some(cause), Operator::Hand(hand), &control, next);
                Ok(())
            }
            MechanismCommand::PointTo { hand, target } => point_to(world, cause, hand, &target),
            MechanismCommand::Fasten { hand, guest } => {
                turn(world, cause, hand, &guest, Turn::Tighter)
            }
            MechanismCommand::Loosen { hand, guest } => {
                turn(world, cause, hand, &guest, Turn::Looser)
            }
            MechanismCommand::Cut { hand, blade } => shears::cut(world, cause, hand, &blade),
        }
    })
}

fn turn(
    world: &mut World,
    cause: CommandId,
    hand: Hand,
    guest: &str,
    turn: Turn,
) -> Result<(), String> {
    let bond = bonds::turned(world, guest, turn)?;
    begin_segment(world, cause);
    bonds::take_turn(world, Some(cause), Operator::Hand(hand), (bond, turn))
}

/// The state to which triggering leads, or the reason why it leads nowhere.
fn next_state(world: &World, id: &str, part: Option<u32>) -> Result<u32, String> {
    let network = Network::of(world);
    let control = network.control(id)?;
    control.next_state(part).ok_or_else(|| match &control.kind {
        ControlKind::ToggleSwitch(_) => {
            format!("`{id}` cannot be triggered there: this side is down")
        }
        ControlKind::PushButton(_) => format!("`{id}` is pressed already"),
        ControlKind::IndicatorLights(_) => {
            format!("`{id}` cannot be triggered: it is a light, which only shows the state of other controls")
        }
        ControlKind::Custom(_) => {
            format!("`{id}` cannot be triggered there in its present state")
        }
    })
}

/// Operates a control, which leads to a state. A button's cap is pushed, and its state follows when the cap is down.
pub(crate) fn trigger(
    world: &mut World,
    cause: Option<CommandId>,
    by: Operator,
    control: &str,
    next: u32,
) {
    world.write_message(SimFact::Mechanism(MechanismFact::Triggered {
        cause,
        by,
        control: control.to_owned(),
    }));
    let mut network = Network::of(world);
    if let Ok(ControlKind::PushButton(_)) = network.control(control).map(|control| &control.kind) {
        button::push_cap(world, control);
        return;
    }
    network.flip(control);
    network.set_state(control, next);
    network.take_effect(world, true);
}

fn point_to(world: &mut World, cause: CommandId, hand: Hand, target: &str) -> Result<(), String> {
    let index = world.resource::<ObjectIndex>();
    let specs = index
        .iter()
        .filter_map(|object| world.get::<ObjectSpec>(object));
    let object = specs
        .into_iter()
        .find(|spec| spec.id == target || spec.has_pointable(target))
        .map(|spec| spec.id.clone())
        .ok_or_else(|| format!("{hand} cannot point to `{target}`: {}", index.lacks(target)))?;
    begin_segment(world, cause);
    world.write_message(SimFact::Mechanism(MechanismFact::PointedTo {
        cause,
        hand,
        part: target.to_owned(),
        object,
    }));
    Ok(())
}
