//! The sight of the world.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Bonds, Hands, ObjectIndex, ObjectSpec, Paused, Robot, RobotLayout, Table};
use tabletop_geometry::Pose;

use crate::seen::{ScenarioObject, Seen};

/// Everything that steps and checks look at.
#[derive(SystemParam)]
pub(crate) struct ScenarioSight<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, &'static Table>,
    hands: Res<'w, Hands>,
    paused: Res<'w, Paused>,
    robot: Res<'w, Robot>,
    bonds: Res<'w, Bonds>,
    layout: Res<'w, RobotLayout>,
}

impl ScenarioSight<'_, '_> {
    /// The present world.
    pub fn seen(&self) -> Seen<'_> {
        let objects = self.index.iter().filter_map(|entity| {
            let (spec, transform) = self.objects.get(entity).ok()?;
            Some(ScenarioObject {
                entity,
                spec,
                pose: Pose::from(transform),
                holder: self.hands.holder_of(entity),
            })
        });
        Seen {
            objects: objects.collect(),
            table: self.tables.iter().next().copied(),
            selected: self.hands.selected,
            paused: self.paused.0,
            robot: &self.robot,
            bonds: &self.bonds,
            layout: &self.layout,
        }
    }
}
