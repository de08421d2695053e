//! A resource.

use std::{any::Any, sync::Arc};

use bevy::prelude::*;

use super::saved::{Earlier, Saved};

/// A resource; `None` if it was absent.
struct SavedResource<R>(Option<Arc<R>>);

pub(crate) fn save<R: Resource + Clone>(
    world: &mut World,
    _entities: &[Entity],
    earlier: Option<Earlier>,
) -> Box<dyn Saved> {
    let ticks = world.get_resource_change_ticks::<R>();
    let unchanged = earlier
        .filter(|earlier| ticks.is_some_and(|ticks| !earlier.since.has_changed(ticks)))
        .and_then(|earlier| earlier.of::<SavedResource<R>>()?.0.clone());
    let resource = || world.get_resource::<R>().cloned().map(Arc::new);
    Box::new(SavedResource(unchanged.or_else(resource)))
}

impl<R: Resource + Clone> Saved for SavedResource<R> {
    fn restore(&self, world: &mut World, _entities: &[Entity]) {
        if let Some(resource) = &self.0 {
            world.insert_resource(R::clone(resource));
        }
    }

    fn bytes(&self, besides: Option<&dyn Saved>) -> usize {
        let other = besides
            .and_then(|other| (other as &dyn Any).downcast_ref::<Self>())
            .and_then(|other| other.0.as_ref());
        match (&self.0, other) {
            (Some(own), Some(other)) if Arc::ptr_eq(own, other) => 0,
            (own, _) => own.as_deref().map_or(0, size_of_val),
        }
    }
}
