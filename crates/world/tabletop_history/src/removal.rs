//! Removing entities so that a snapshot can bring them back.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use tabletop_core::Rollback;

/// The reasons for which removed entities are kept, disabled, so that a snapshot can bring them back.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct KeepRemoved {
    /// Removed entities are kept for undo.
    pub for_undo: bool,
    /// Removed entities are kept for a player that goes back.
    pub for_playback: bool,
}

impl KeepRemoved {
    /// True if any reason applies.
    pub const fn is_on(self) -> bool {
        self.for_undo || self.for_playback
    }
}

/// Marks an entity that was removed from the world while removed entities are [kept](KeepRemoved).
#[derive(Component, Clone, Copy, Debug, Reflect)]
#[reflect(Component)]
pub struct Parked;

/// Removes an entity from the world: for good, or until a snapshot brings it back.
pub fn despawn_or_park(world: &mut World, entity: Entity) {
    let keep = world.get_resource::<KeepRemoved>();
    if keep.is_some_and(|keep| keep.is_on()) {
        world.entity_mut(entity).insert(Parked).insert(Disabled);
    } else {
        world.despawn(entity);
    }
}

/// Removes parked entities for good, if no reason keeps them any more.
pub fn drop_removed(world: &mut World) {
    let keep = world.get_resource::<KeepRemoved>();
    if keep.is_some_and(|keep| keep.is_on()) {
        return;
    }
    let mut disabled = world.query_filtered::<Entity, (With<Rollback>, With<Disabled>)>();
    for entity in disabled.iter(world).collect::<Vec<_>>() {
        world.try_despawn(entity).ok();
    }
}
