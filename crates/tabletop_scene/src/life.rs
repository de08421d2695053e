//! How objects appear on the table and go from it.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Joint, ObjectIndex, ObjectSpec, SceneSpec, SimCommand, SimFact, Table};

use crate::{Assembly, IdAllocator, assemble};

/// Objects below this height, in units, have left the world.
const LOWEST_Z: f32 = -1000.0;

/// The table and what is on it, to be changed.
#[derive(SystemParam)]
pub(crate) struct Tabletop<'w, 's> {
    commands: Commands<'w, 's>,
    index: ResMut<'w, ObjectIndex>,
    tables: Query<'w, 's, Entity, With<Table>>,
    objects: Query<'w, 's, &'static ObjectSpec>,
    joints: Query<'w, 's, (Entity, &'static Joint)>,
    facts: MessageWriter<'w, SimFact>,
}

impl Tabletop<'_, '_> {
    fn clear(&mut self) {
        let objects: Vec<_> = self.index.iter().collect();
        for object in objects {
            self.remove(object);
        }
    }

    fn set(&mut self, scene: &SceneSpec) {
        self.clear();
        for table in &self.tables {
            self.commands.entity(table).despawn();
        }
        let mut ids = IdAllocator::default();
        self.put(assemble(scene, &mut ids));
    }

    fn put(&mut self, assembly: Assembly) {
        self.commands.spawn(assembly.table);
        for spec in assembly.objects {
            let id = spec.id.clone();
            let object = self.commands.spawn((Transform::from(spec.pose), spec)).id();
            self.index.insert(id.clone(), object);
            self.facts.write(SimFact::ObjectCreated { id, object });
        }
        for joint in assembly.joints {
            let [first, second] = joint.objects.each_ref().map(|id| self.index.get(id));
            if let (Some(first), Some(second)) = (first, second) {
                self.commands.spawn((
                    Joint {
                        objects: [first, second],
                        frames: joint.frames,
                        kind: joint.kind,
                    },
                    ChildOf(second),
                ));
            }
        }
    }

    fn remove(&mut self, object: Entity) {
        let Ok(spec) = self.objects.get(object) else {
            return;
        };
        for (joint, connection) in &self.joints {
            if connection.objects.contains(&object) {
                self.commands.entity(joint).try_despawn();
            }
        }
        self.index.remove(&spec.id);
        self.commands.entity(object).try_despawn();
        self.facts.write(SimFact::ObjectDeleted {
            id: spec.id.clone(),
        });
    }
}

pub(crate) fn carry_out_commands(mut commands: MessageReader<SimCommand>, mut tabletop: Tabletop) {
    for command in commands.read() {
        match command {
            SimCommand::SetScene(scene) => tabletop.set(scene),
            SimCommand::ClearTable => tabletop.clear(),
            SimCommand::LoadTask(_) | SimCommand::SetPaused(_) => {}
        }
    }
}

pub(crate) fn remove_fallen(
    transforms: Query<(Entity, &Transform), With<ObjectSpec>>,
    mut tabletop: Tabletop,
) {
    let fallen: Vec<_> = tabletop
        .index
        .iter()
        .filter(|&object| {
            transforms
                .get(object)
                .is_ok_and(|(_, transform)| transform.translation.z < LOWEST_Z)
        })
        .collect();
    for object in fallen {
        tabletop.remove(object);
    }
}
