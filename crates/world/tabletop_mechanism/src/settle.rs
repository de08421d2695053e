//! Settling of mechanisms when objects appear and disappear: states are passed on, initial bonds made.

use bevy::prelude::*;
use tabletop_core::{Bond, Bonds, ObjectSpec, SimFact};
use tabletop_history::Parked;

use crate::{
    bonds,
    network::Network,
    press::{Pressable, is_pressable},
};

/// Objects that have appeared in this tick.
#[derive(Resource, Clone, Default)]
pub(crate) struct New(Vec<Entity>);

pub(crate) fn any(new: Res<New>) -> bool {
    !new.0.is_empty()
}

pub(crate) fn note_new(
    add: On<Add, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    mut new: ResMut<New>,
    mut commands: Commands,
) {
    let does_something =
        |spec: &ObjectSpec| !spec.controls().is_empty() || !spec.guest_points().is_empty();
    if objects.get(add.entity).is_ok_and(does_something) {
        new.0.push(add.entity);
    }
    if objects.get(add.entity).is_ok_and(is_pressable) {
        commands.entity(add.entity).try_insert(Pressable);
    }
}

pub(crate) fn note_despawned(
    remove: On<Remove, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    bonds: Res<Bonds>,
    commands: Commands,
) {
    if let Ok(spec) = objects.get(remove.entity) {
        forget_bonds(spec, &bonds, commands);
    }
}

pub(crate) fn note_parked(
    park: On<Add, Parked>,
    objects: Query<&ObjectSpec>,
    bonds: Res<Bonds>,
    commands: Commands,
) {
    if let Ok(spec) = objects.get(park.entity) {
        forget_bonds(spec, &bonds, commands);
    }
}

fn forget_bonds(spec: &ObjectSpec, bonds: &Bonds, mut commands: Commands) {
    let is_bonded = |bond: &Bond| bond.guest == spec.id || bond.host == spec.id;
    if bonds.0.iter().any(is_bonded) {
        let id = spec.id.clone();
        commands.queue(move |world: &mut World| bonds::forget(world, &id));
    }
}

/// Passes on the states of new controls, in the order in which they appeared, and makes the initial bonds of new objects.
pub(crate) fn settle(world: &mut World) {
    let new = std::mem::take(&mut world.resource_mut::<New>().0);
    let specs: Vec<_> = new
        .iter()
        .filter_map(|&object| world.get::<ObjectSpec>(object).cloned())
        .collect();
    let mut network = Network::of(world);
    for spec in &specs {
        for control in spec.controls() {
            network.hand_on(control.id);
        }
    }
    network.take_effect(world, false);
    for spec in &specs {
        for (point, guest) in spec.guest_points() {
            if guest.tightness > 0
                && let Err(reason) = make(world, point.id, &guest.host, guest.tightness)
            {
                let reason = format!("`{}` cannot be fastened at first: {reason}", spec.id);
                world.write_message(SimFact::Refused {
                    cause: None,
                    reason,
                });
            }
        }
    }
}

/// Makes the bond that a guest point has at first.
fn make(
    world: &mut World,
    guest_point: &str,
    host_point: &str,
    tightness: u32,
) -> Result<(), String> {
    let bond = bonds::first(world, guest_point, host_point, tightness)?;
    bonds::bring_about(world, &bond)?;
    let mut network = Network::of(world);
    bonds::have_effect(world, &mut network, &bond);
    network.take_effect(world, false);
    Ok(())
}
