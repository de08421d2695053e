//! Which objects came from one item of a scene.

use bevy::prelude::*;
use tabletop_core::SceneItem;

/// The chains, lid boxes and jointed objects of the present scene.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Compounds(Vec<Compound>);

/// A chain, a lid box, or two jointed objects.
#[derive(Clone, Debug)]
pub(crate) struct Compound {
    /// What the scene said.
    pub item: SceneItem,
    /// What it consists of, in the order of its assembly.
    pub members: Vec<Entity>,
}

impl Compounds {
    /// Notes of which objects an item consists, if they are several.
    pub fn note(&mut self, item: &SceneItem, members: &[Entity]) {
        if members.len() > 1 {
            self.0.push(Compound {
                item: item.clone(),
                members: members.to_vec(),
            });
        }
    }

    /// Forgets those of which something has gone.
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
