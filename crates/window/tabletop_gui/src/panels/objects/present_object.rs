//! The objects on the table as the panel shows them.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Held, ObjectIndex, ObjectSpec};
use tabletop_geometry::Pose;

/// An object as it is now.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PresentObject {
    /// Its description, with its present pose.
    pub spec: ObjectSpec,
    /// The hand or gripper that holds it.
    pub holder: Option<String>,
}

/// The objects on the table.
#[derive(SystemParam)]
pub(super) struct OnTable<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<
        'w,
        's,
        (
            &'static ObjectSpec,
            &'static Transform,
            Option<&'static Held>,
        ),
    >,
}

impl OnTable<'_, '_> {
    /// All of them, by their ids.
    pub fn all(&self) -> Vec<PresentObject> {
        let objects = self.index.ids();
        objects
            .filter_map(|id| self.present(self.index.get(id)?))
            .collect()
    }

    /// The object of this id.
    pub fn entity(&self, id: &str) -> Option<Entity> {
        self.index.get(id)
    }

    /// One of them.
    pub fn present(&self, object: Entity) -> Option<PresentObject> {
        let (spec, place, held) = self.objects.get(object).ok()?;
        Some(PresentObject {
            spec: ObjectSpec {
                pose: Pose::from(place),
                ..spec.clone()
            },
            holder: held.map(|held| held.by.to_string()),
        })
    }
}
