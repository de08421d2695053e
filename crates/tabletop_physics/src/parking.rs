//! Removing objects so that a snapshot can bring them back.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};

use crate::snapshot::remove_body;

/// Whether removed objects are kept as disabled entities, because a snapshot may bring them back.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeepRemoved(pub bool);

/// Marks an object that was removed from the world while removed objects are [kept](KeepRemoved).
#[derive(Component, Clone, Copy, Debug)]
pub struct Parked;

/// Removes an object from the world. Its body goes at once, so that it makes no difference to the others whether the object is kept.
pub fn remove_object(world: &mut World, object: Entity) {
    remove_body(world, object);
    let keep = world.get_resource::<KeepRemoved>();
    if keep.is_some_and(|keep| keep.0) {
        world.entity_mut(object).insert(Parked).insert(Disabled);
    } else {
        world.despawn(object);
    }
}
