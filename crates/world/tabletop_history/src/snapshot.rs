//! Snapshots of the world.

use bevy::{
    ecs::{change_detection::Tick, entity_disabling::Disabled},
    prelude::*,
};
use tabletop_core::Rollback;

use crate::{
    removal::Parked,
    rollback::{Earlier, RollbackRegistry, RollingBack, Saved, Since},
};

/// The world between two ticks, bit for bit: a [restored](Self::restore) world goes on exactly as it did then.
///
/// Entities that were removed since must have been [kept](crate::KeepRemoved). The pause of the simulation is not part
/// of it.
pub struct WorldSnapshot {
    /// In order.
    entities: Vec<Entity>,
    /// In the order of the registry.
    parts: Vec<Box<dyn Saved>>,
}

impl WorldSnapshot {
    /// A snapshot of the present world.
    pub fn take(world: &mut World) -> Self {
        Self::take_sharing(world, None)
    }

    /// A snapshot of the present world that shares unchanged state with an earlier one.
    pub(crate) fn take_sharing(world: &mut World, earlier: Option<(&Self, Tick)>) -> Self {
        let registry = world.resource::<RollbackRegistry>().clone();
        let mut query = world.query_filtered::<Entity, With<Rollback>>();
        let mut entities: Vec<_> = query.iter(world).collect();
        entities.sort_unstable();
        let earlier = earlier.map(|(snapshot, then)| (snapshot, Since::new(then, world)));
        let parts = registry.parts().enumerate().map(|(number, part)| {
            let earlier = earlier.and_then(|(snapshot, since)| {
                Some(Earlier {
                    entities: &snapshot.entities,
                    saved: &**snapshot.parts.get(number)?,
                    since,
                })
            });
            (part.save)(world, &entities, earlier)
        });
        let parts = parts.collect();
        Self { entities, parts }
    }

    /// Restores the world. Entities that have appeared since are disabled.
    pub fn restore(&self, world: &mut World) {
        world.insert_resource(RollingBack(true));
        let mut query = world.query_filtered::<Entity, With<Rollback>>();
        for entity in query.iter(world).collect::<Vec<_>>() {
            if self.entities.binary_search(&entity).is_err() {
                world.entity_mut(entity).insert(Disabled);
            }
        }
        for &entity in &self.entities {
            if let Ok(mut entity) = world.get_entity_mut(entity) {
                entity.remove::<(Parked, Disabled)>();
            }
        }
        for part in &self.parts {
            part.restore(world, &self.entities);
        }
        world.insert_resource(RollingBack(false));
    }

    /// Memory, in bytes, that it does not share with another one.
    pub(crate) fn bytes(&self, besides: Option<&Self>) -> usize {
        let own = size_of::<Self>() + size_of_val(&*self.entities);
        let parts = self.parts.iter().enumerate().map(|(number, part)| {
            let other = besides.and_then(|other| other.parts.get(number));
            size_of_val(part) + part.bytes(other.map(|other| &**other))
        });
        own + parts.sum::<usize>()
    }
}
