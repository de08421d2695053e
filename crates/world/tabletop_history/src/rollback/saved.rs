//! A saved part of the world.

use std::any::Any;

use bevy::{
    ecs::change_detection::{ComponentTicks, Tick},
    prelude::*,
};

/// A saved part of the world.
pub(crate) trait Saved: Any + Send + Sync {
    /// Restores it. `entities` are those of the snapshot.
    fn restore(&self, world: &mut World, entities: &[Entity]);

    /// Memory, in bytes, that it does not share with another one.
    fn bytes(&self, besides: Option<&dyn Saved>) -> usize;
}

/// An earlier snapshot, for sharing unchanged state.
#[derive(Clone, Copy)]
pub(crate) struct Earlier<'a> {
    pub entities: &'a [Entity],
    pub saved: &'a dyn Saved,
    pub since: Since,
}

impl<'a> Earlier<'a> {
    pub fn of<S: Saved>(self) -> Option<&'a S> {
        (self.saved as &dyn Any).downcast_ref()
    }
}

/// A moment after which changes are detected.
#[derive(Clone, Copy, Debug)]
pub struct Since {
    then: Tick,
    now: Tick,
}

/// Largest age of a known change: Bevy forgets changes older than about three of these.
const OLDEST: u32 = 1 << 30;

impl Since {
    pub(crate) fn new(then: Tick, world: &World) -> Self {
        let now = world.read_change_tick();
        Self { then, now }
    }

    /// True if something has changed since, or may have.
    pub fn has_changed(self, ticks: ComponentTicks) -> bool {
        let age = self.now.get().wrapping_sub(self.then.get());
        age > OLDEST || ticks.is_changed(self.then, self.now)
    }
}
