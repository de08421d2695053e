//! State that rolls back and is neither a component nor a resource.

use std::any::Any;

use bevy::prelude::*;

use super::saved::{Earlier, Saved, Since};

/// State on which later ticks depend and that is neither a resource nor a component of an entity that rolls back, such as that of
/// Rapier.
pub trait RollbackState: Send + Sync + Sized + 'static {
    /// The present state, sharing unchanged parts with an earlier one; `None` in a world that has none.
    fn save(world: &mut World, earlier: Option<(&Self, Since)>) -> Option<Self>;

    /// Restores this state.
    fn restore(&self, world: &mut World);

    /// Memory, in bytes, that it does not share with another one.
    fn bytes(&self, besides: Option<&Self>) -> usize;
}

struct SavedState<S>(Option<S>);

pub(crate) fn save<S: RollbackState>(
    world: &mut World,
    _entities: &[Entity],
    earlier: Option<Earlier>,
) -> Box<dyn Saved> {
    let earlier = earlier.and_then(|earlier| {
        let state = earlier.of::<SavedState<S>>()?.0.as_ref()?;
        Some((state, earlier.since))
    });
    Box::new(SavedState(S::save(world, earlier)))
}

impl<S: RollbackState> Saved for SavedState<S> {
    fn restore(&self, world: &mut World, _entities: &[Entity]) {
        if let Some(state) = &self.0 {
            state.restore(world);
        }
    }

    fn bytes(&self, besides: Option<&dyn Saved>) -> usize {
        let other = besides
            .and_then(|other| (other as &dyn Any).downcast_ref::<Self>())
            .and_then(|other| other.0.as_ref());
        self.0.as_ref().map_or(0, |state| state.bytes(other))
    }
}
