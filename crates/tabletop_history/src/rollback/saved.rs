//! A part of the world as it was.

use std::any::Any;

use bevy::{
    ecs::change_detection::{ComponentTicks, Tick},
    prelude::*,
};

/// A part of the world as it was.
pub(crate) trait Saved: Any + Send + Sync {
    /// Puts it back. `entities` are those that there were.
    fn restore(&self, world: &mut World, entities: &[Entity]);

    /// The memory, in bytes, that it does not share with another one.
    fn bytes(&self, besides: Option<&dyn Saved>) -> usize;
}

/// An earlier snapshot, for what has not changed since.
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

/// A moment, to ask what has changed since.
#[derive(Clone, Copy, Debug)]
pub struct Since {
    then: Tick,
    now: Tick,
}

/// Bevy forgets when a change was that is older than some three of these.
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
