//! The sight of the world.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Bonds, Hands, Joint, ObjectIndex, ObjectSpec, Paused, Robot, RobotLayout, Table,
};
use tabletop_geometry::Pose;
use tabletop_program::TableScene;

use crate::seen::{ScenarioObject, Seen};

/// The table of a world as programs of tasks see it now.
///
/// # Errors
/// The world is no simulator's.
pub fn table_scene(world: &mut World) -> Result<TableScene> {
    Ok(world.run_system_cached(seen_table)?)
}

fn seen_table(sight: ScenarioSight) -> TableScene {
    sight.seen().table_scene()
}

/// Everything that steps and checks look at.
#[derive(SystemParam)]
pub(crate) struct ScenarioSight<'w, 's> {
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, &'static Table>,
    joints: Query<'w, 's, &'static Joint>,
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
            joints: self.joints.iter().copied().collect(),
            selected: self.hands.selected,
            paused: self.paused.0,
            robot: &self.robot,
            bonds: &self.bonds,
            layout: &self.layout,
        }
    }
}
