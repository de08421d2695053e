//! Compounds: several objects from one item of a scene.

use bevy::prelude::*;
use tabletop_core::SceneItem;

/// The chains, lid boxes and jointed objects of the present scene.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Compounds(Vec<Compound>);

/// A chain, a lid box, or two jointed objects.
#[derive(Clone, Debug)]
pub(crate) struct Compound {
    /// The item as in the scene.
    pub item: SceneItem,
    /// Its objects, in the order of assembly.
    pub members: Vec<Entity>,
}

impl Compounds {
    /// Adds a compound if an item has several objects.
    pub fn note(&mut self, item: &SceneItem, members: &[Entity]) {
        if members.len() > 1 {
            self.0.push(Compound {
                item: item.clone(),
                members: members.to_vec(),
            });
        }
    }

    /// Forgets compounds of which an object is gone.
    pub fn forget_broken(&mut self, is_there: impl Fn(Entity) -> bool) {
        self.0
            .retain(|compound| compound.members.iter().all(|&member| is_there(member)));
    }

    /// The compound that an object is a part of.
    pub fn of(&self, object: Entity) -> Option<&Compound> {
        self.0
            .iter()
            .find(|compound| compound.members.contains(&object))
    }
}
