//! The object that the keyboard acts on.

use bevy::prelude::*;
use tabletop_core::ObjectIndex;

/// The object that the user has chosen with the keyboard: keys take, move and turn it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Chosen(pub Option<Entity>);

impl Chosen {
    /// Chooses the object that was made after the chosen one, or with `is_back` the one before; round and round.
    pub fn go_on(&mut self, index: &ObjectIndex, is_back: bool) {
        let objects: Vec<_> = index.iter().collect();
        let at = objects.iter().position(|&object| Some(object) == self.0);
        let next = match (at, is_back) {
            (None, false) => 0,
            (None, true) => objects.len().saturating_sub(1),
            (Some(at), false) => (at + 1) % objects.len(),
            (Some(at), true) => (at + objects.len() - 1) % objects.len(),
        };
        self.0 = objects.get(next).copied();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_chosen_round_and_round() {
        let mut world = World::new();
        let mut index = ObjectIndex::default();
        let mut chosen = Chosen::default();
        chosen.go_on(&index, false);
        assert_eq!(chosen, Chosen(None));
        let objects = ["a", "b", "c"].map(|id| {
            let object = world.spawn_empty().id();
            index.insert(id, object);
            object
        });
        let mut visited = |is_back: bool| {
            chosen.go_on(&index, is_back);
            objects.iter().position(|&object| chosen.0 == Some(object))
        };
        let forth = [false; 4].map(&mut visited);
        assert_eq!(forth, [Some(0), Some(1), Some(2), Some(0)]);
        assert_eq!([true; 2].map(&mut visited), [Some(2), Some(1)]);
        index.remove("b");
        chosen.go_on(&index, false);
        assert_eq!(chosen.0, Some(objects[0]));
    }
}
