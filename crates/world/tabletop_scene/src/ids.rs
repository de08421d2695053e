//! Unique ids.

use std::collections::BTreeSet;

use bevy::prelude::Resource;
use tabletop_core::{ObjectSpec, Part, Shape};

/// Gives out unique ids in the way of the original program: the id that was asked for (`obj` if none) if it is
/// free, otherwise that id with `#` and a count that goes up with every try.
///
/// ```
/// use tabletop_scene::IdAllocator;
///
/// let mut ids = IdAllocator::default();
/// let given = ["a", "a", "", "", "a"].map(|wanted| ids.unique(wanted));
/// assert_eq!(given, ["a", "a#0", "obj", "obj#1", "a#2"]);
/// ```
///
/// As a resource, it is the allocator of the present scene.
#[derive(Resource, Clone, Debug, Default)]
pub struct IdAllocator {
    taken: BTreeSet<String>,
    tries: u64,
}

impl IdAllocator {
    /// An allocator for which these ids are taken.
    pub fn with_taken(taken: impl IntoIterator<Item = String>) -> Self {
        Self {
            taken: taken.into_iter().collect(),
            tries: 0,
        }
    }

    /// Marks ids as taken that were given elsewhere.
    pub fn take(&mut self, taken: impl IntoIterator<Item = String>) {
        self.taken.extend(taken);
    }

    /// Takes an unused id.
    pub fn unique(&mut self, wanted: &str) -> String {
        let base = if wanted.is_empty() { "obj" } else { wanted };
        let mut id = base.to_owned();
        while self.taken.contains(&id) {
            id = format!("{base}#{}", self.tries);
            self.tries += 1;
        }
        self.taken.insert(id.clone());
        id
    }
}

/// The object with unique ids for itself, its controls, its bond points and its pointable parts.
pub fn with_unique_ids(mut object: ObjectSpec, ids: &mut IdAllocator) -> ObjectSpec {
    object.id = ids.unique(&object.id);
    if let Shape::Composite { parts } = &mut object.shape {
        give_ids(parts, ids);
    }
    object
}

fn give_ids(parts: &mut [Part], ids: &mut IdAllocator) {
    for part in parts {
        let is_spoken_of = matches!(part.shape, Shape::Control(_) | Shape::BondPoint(_));
        if is_spoken_of || part.pointable {
            part.id = ids.unique(&part.id);
        }
        if let Shape::Composite { parts } = &mut part.shape {
            give_ids(parts, ids);
        }
    }
}
