//! What stands on, in and around what, found once for a table.

use std::collections::BTreeMap;

use tabletop_core::ObjectSpec;
use tabletop_task::Arrangement;

/// What objects stand on, in and around.
pub(crate) struct Standing(BTreeMap<String, ObjectStanding>);

#[derive(Default)]
struct ObjectStanding {
    supports: Vec<String>,
    containers: Vec<String>,
    posts: Vec<String>,
    is_on_table: bool,
}

impl Standing {
    pub fn of(objects: &[ObjectSpec]) -> Self {
        let placed = objects.iter();
        let placed = placed.map(|object| (object.id.as_str(), &object.shape, object.pose));
        let arrangement = Arrangement::new(placed);
        let owned = |ids: Vec<&str>| ids.into_iter().map(str::to_owned).collect();
        let all = objects.iter().map(|object| {
            let id = object.id.as_str();
            let standing = ObjectStanding {
                supports: owned(arrangement.supports(id)),
                containers: owned(arrangement.containers(id)),
                posts: owned(arrangement.posts(id)),
                is_on_table: arrangement.is_on_table(id),
            };
            (id.to_owned(), standing)
        });
        Self(all.collect())
    }

    /// True if an object touches the table's top.
    pub fn is_on_table(&self, id: &str) -> bool {
        self.0.get(id).is_some_and(|object| object.is_on_table)
    }

    /// True if an object rests on another one itself.
    pub fn rests_on(&self, id: &str, base: &str) -> bool {
        self.has(id, base, |object| &object.supports)
    }

    /// The object on which an object rests.
    pub fn support(&self, id: &str) -> Option<&str> {
        self.0.get(id)?.supports.first().map(String::as_str)
    }

    /// True if an object has the walls of another one on all sides.
    pub fn is_between_walls(&self, id: &str, container: &str) -> bool {
        self.has(id, container, |object| &object.containers)
    }

    /// True if an object is around another one, as a ring is around a peg.
    pub fn is_around(&self, id: &str, post: &str) -> bool {
        self.has(id, post, |object| &object.posts)
    }

    /// True if an object is around any other one.
    pub fn is_ring(&self, id: &str) -> bool {
        self.0
            .get(id)
            .is_some_and(|object| !object.posts.is_empty())
    }

    /// The objects that rest on another one itself, in the order of their ids.
    pub fn on<'a>(&'a self, base: &'a str) -> impl Iterator<Item = &'a str> {
        let ids = self.0.keys().map(String::as_str);
        ids.filter(move |id| self.rests_on(id, base))
    }

    fn has(&self, id: &str, other: &str, which: fn(&ObjectStanding) -> &Vec<String>) -> bool {
        let object = self.0.get(id);
        object.is_some_and(|object| which(object).iter().any(|known| known == other))
    }
}
