//! The objects on the table, and how to find them.

use std::collections::BTreeMap;

use bevy::prelude::*;

use crate::misspelling::nearest_name;

/// The most ids that are named when one is missing.
const MOST_NAMED: usize = 8;

/// The index of the objects on the table: by id, and in the order in which they were created.
#[derive(Resource, Clone, Debug, Default, Reflect)]
#[reflect(Resource)]
pub struct ObjectIndex {
    by_id: BTreeMap<String, Entity>,
    in_order: Vec<Entity>,
}

impl ObjectIndex {
    /// The object with this id.
    pub fn get(&self, id: &str) -> Option<Entity> {
        self.by_id.get(id).copied()
    }

    /// The objects in the order of their creation.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Entity> + '_ {
        self.in_order.iter().copied()
    }

    /// The ids, in alphabetical order.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.by_id.keys().map(String::as_str)
    }

    /// Why nothing is found by this id: the id that may be meant, or those there are.
    pub fn lacks(&self, id: &str) -> String {
        let ids: Vec<_> = self.ids().collect();
        if let Some(near) = nearest_name(id, &ids) {
            return format!("there is no such object; did you mean {near}?");
        }
        let named = ids[..ids.len().min(MOST_NAMED)].join(", ");
        match ids.len().saturating_sub(MOST_NAMED) {
            _ if ids.is_empty() => "there is no such object; the table is empty".into(),
            0 => format!("there is no such object, only {named}"),
            more => format!("there is no such object, only {named} and {more} more"),
        }
    }

    /// Number of objects.
    pub fn len(&self) -> usize {
        self.in_order.len()
    }

    /// True if the table is empty.
    pub fn is_empty(&self) -> bool {
        self.in_order.is_empty()
    }

    /// Adds a new object. If its id is taken, the new object takes it over.
    pub fn insert(&mut self, id: impl Into<String>, object: Entity) {
        if let Some(previous) = self.by_id.insert(id.into(), object) {
            self.in_order.retain(|&entity| entity != previous);
        }
        self.in_order.push(object);
    }

    /// Removes an object, and returns its entity.
    pub fn remove(&mut self, id: &str) -> Option<Entity> {
        let object = self.by_id.remove(id)?;
        self.in_order.retain(|&entity| entity != object);
        Some(object)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_id_is_answered_with_those_there_are() {
        let mut world = World::new();
        let mut index = ObjectIndex::default();
        assert_eq!(
            index.lacks("Red"),
            "there is no such object; the table is empty"
        );
        for id in ["RedBlock", "Box"] {
            index.insert(id, world.spawn_empty().id());
        }
        assert_eq!(
            index.lacks("redBlok"),
            "there is no such object; did you mean RedBlock?"
        );
        assert_eq!(
            index.lacks("cup"),
            "there is no such object, only Box, RedBlock"
        );
        for number in 0..10 {
            index.insert(format!("{number}"), world.spawn_empty().id());
        }
        assert!(index.lacks("cup").ends_with("6, 7 and 4 more"));
    }

    #[test]
    fn the_index_keeps_the_order_of_creation() {
        let mut world = World::new();
        let [a, b, c] = std::array::from_fn(|_| world.spawn_empty().id());
        let mut index = ObjectIndex::default();
        index.insert("z", a);
        index.insert("a", b);
        index.insert("m", c);
        assert_eq!(index.remove("a"), Some(b));
        assert_eq!(index.iter().collect::<Vec<_>>(), [a, c]);
        assert_eq!(index.get("m"), Some(c));
        assert_eq!(index.get("a"), None);
    }
}
