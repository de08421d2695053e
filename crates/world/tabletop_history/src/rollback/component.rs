//! A component of all entities that roll back.

use std::{any::Any, sync::Arc};

use bevy::prelude::*;

use super::saved::{Earlier, Saved};

/// Number of entities that share a saved chunk.
const CHUNK: usize = 16;

/// A component of entities, in their order.
struct Column<C>(Vec<Arc<[Option<C>]>>);

pub(crate) fn save<C: Component + Clone>(
    world: &mut World,
    entities: &[Entity],
    earlier: Option<Earlier>,
) -> Box<dyn Saved> {
    let world = &*world;
    let chunks = entities
        .chunks(CHUNK)
        .enumerate()
        .map(|(number, entities)| {
            earlier
                .and_then(|earlier| unchanged(world, entities, number, earlier))
                .unwrap_or_else(|| {
                    let components = entities
                        .iter()
                        .map(|&entity| world.get::<C>(entity).cloned());
                    components.collect()
                })
        });
    Box::new(Column(chunks.collect()))
}

/// The chunk saved earlier of these entities, if nothing in it has changed.
fn unchanged<C: Component + Clone>(
    world: &World,
    entities: &[Entity],
    number: usize,
    earlier: Earlier,
) -> Option<Arc<[Option<C>]>> {
    let entities_then = earlier.entities.chunks(CHUNK).nth(number)?;
    let saved = earlier.of::<Column<C>>()?.0.get(number)?;
    let is_as_it_was =
        |(&entity, then): (&Entity, &Option<C>)| match world.entity(entity).get_change_ticks::<C>()
        {
            Some(ticks) => then.is_some() && !earlier.since.has_changed(ticks),
            None => then.is_none(),
        };
    let is_unchanged =
        entities == entities_then && entities.iter().zip(saved.iter()).all(is_as_it_was);
    is_unchanged.then(|| saved.clone())
}

impl<C: Component + Clone> Saved for Column<C> {
    fn restore(&self, world: &mut World, entities: &[Entity]) {
        let components = self.0.iter().flat_map(|chunk| chunk.iter());
        for (&entity, component) in entities.iter().zip(components) {
            let Ok(mut entity) = world.get_entity_mut(entity) else {
                continue;
            };
            match component {
                Some(component) => entity.insert(component.clone()),
                None => entity.remove::<C>(),
            };
        }
    }

    fn bytes(&self, besides: Option<&dyn Saved>) -> usize {
        let other = besides.and_then(|other| (other as &dyn Any).downcast_ref::<Self>());
        let is_shared = |number: usize, chunk: &Arc<_>| {
            let others = other.and_then(|other| other.0.get(number));
            others.is_some_and(|other| Arc::ptr_eq(chunk, other))
        };
        let chunks = self.0.iter().enumerate();
        chunks
            .map(|(number, chunk)| {
                let own = match is_shared(number, chunk) {
                    true => 0,
                    false => size_of_val(&**chunk),
                };
                size_of_val(chunk) + own
            })
            .sum()
    }
}
