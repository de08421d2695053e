//! The rollback registry, in which owners register their state.

mod component;
mod resource;
mod saved;
mod state;

pub use saved::Since;
pub(crate) use saved::{Earlier, Saved};
pub use state::RollbackState;

use std::any::TypeId;

use bevy::prelude::*;

/// Registers the state of a plugin that rolls back.
pub trait RollbackApp {
    /// Undo and redo restore this component of entities marked [`Rollback`](tabletop_core::Rollback), and remove it where it was absent.
    fn rollback_component<C: Component + Clone>(&mut self) -> &mut Self;

    /// This component of entities that roll back is derived: it is computed again from state that rolls back, before anything reads it.
    fn derived_component<C: Component>(&mut self) -> &mut Self;

    /// Undo and redo restore this resource.
    fn rollback_resource<R: Resource + Clone>(&mut self) -> &mut Self;

    /// Undo and redo restore this state, which is neither component nor resource, after all components and resources.
    fn rollback_state<S: RollbackState>(&mut self) -> &mut Self;
}

impl RollbackApp for App {
    fn rollback_component<C: Component + Clone>(&mut self) -> &mut Self {
        registry(self).add(
            RollbackKind::Component,
            TypeId::of::<C>(),
            component::save::<C>,
        );
        self
    }

    fn derived_component<C: Component>(&mut self) -> &mut Self {
        registry(self).derived.push(TypeId::of::<C>());
        self
    }

    fn rollback_resource<R: Resource + Clone>(&mut self) -> &mut Self {
        registry(self).add(
            RollbackKind::Resource,
            TypeId::of::<R>(),
            resource::save::<R>,
        );
        self
    }

    fn rollback_state<S: RollbackState>(&mut self) -> &mut Self {
        registry(self).add(RollbackKind::State, TypeId::of::<S>(), state::save::<S>);
        self
    }
}

fn registry(app: &mut App) -> Mut<'_, RollbackRegistry> {
    app.init_resource::<RollingBack>()
        .world_mut()
        .get_resource_or_init()
}

/// Everything that rolls back.
#[derive(Resource, Clone, Debug, Default)]
pub struct RollbackRegistry {
    /// In the order in which they are restored.
    parts: Vec<RollbackPart>,
    derived: Vec<TypeId>,
}

/// A part of the state that rolls back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RollbackPart {
    kind: RollbackKind,
    of: TypeId,
    pub save: Save,
}

/// Copies a part of the world with these entities, or shares it with an earlier snapshot.
type Save = fn(&mut World, &[Entity], Option<Earlier>) -> Box<dyn Saved>;

/// The kinds of state, in the order in which they are restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum RollbackKind {
    Resource,
    Component,
    State,
}

impl RollbackRegistry {
    fn add(&mut self, kind: RollbackKind, of: TypeId, save: Save) {
        if self
            .parts
            .iter()
            .all(|part| (part.kind, part.of) != (kind, of))
        {
            self.parts.push(RollbackPart { kind, of, save });
            self.parts.sort_by_key(|part| part.kind);
        }
    }

    pub(crate) fn parts(&self) -> impl Iterator<Item = RollbackPart> {
        self.parts.iter().copied()
    }

    /// True if undo restores a component or resource, or derives it from restored state.
    pub fn covers(&self, id: TypeId) -> bool {
        self.parts.iter().any(|part| part.of == id) || self.derived.contains(&id)
    }
}

/// True while the world is being restored. Observers of state that rolls back do nothing meanwhile, because their effects
/// are restored as well.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RollingBack(pub(crate) bool);

/// Run condition for observers: the world is being restored.
pub fn is_rolling_back(rolling_back: Option<Res<RollingBack>>) -> bool {
    rolling_back.is_some_and(|rolling_back| rolling_back.0)
}
