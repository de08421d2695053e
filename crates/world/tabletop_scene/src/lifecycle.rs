//! Life of objects: their appearance on the table and their removal.

use bevy::{
    ecs::{
        entity_disabling::Disabled,
        system::{SystemParam, SystemState},
    },
    prelude::*,
};
use tabletop_core::{
    Cause, Held, IssuedCommand, Joint, ObjectIndex, ObjectSpec, SceneCommand, SceneFact, SceneSpec,
    SimFact, Table, carry_out,
};
use tabletop_history::{Parked, begin_change};
use tabletop_physics::{remove_object, renew_if_empty};

use crate::{Assembly, IdAllocator, compound::Compounds, edit, preset};

/// Objects below this height, in units, have left the world.
const LOWEST_Z: f32 = -1000.0;

pub(crate) fn note_created(
    add: On<Add, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    cause: Res<Cause>,
    mut index: ResMut<ObjectIndex>,
    mut facts: MessageWriter<SimFact>,
) -> Result {
    let id = &objects.get(add.entity)?.id;
    index.insert(id, add.entity);
    facts.write(SimFact::Scene(SceneFact::ObjectCreated {
        cause: cause.0,
        id: id.clone(),
        object: add.entity,
    }));
    Ok(())
}

pub(crate) fn note_despawned(
    remove: On<Remove, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    joints: Query<(Entity, &Joint)>,
    mut forget: Forget,
    mut commands: Commands,
) {
    let Ok(spec) = objects.get(remove.entity) else {
        return; // It was parked before.
    };
    for (joint, connection) in &joints {
        if connection.objects.contains(&remove.entity) {
            commands.entity(joint).try_despawn();
        }
    }
    forget.object(spec);
}

pub(crate) fn note_parked(
    park: On<Add, Parked>,
    objects: Query<&ObjectSpec>,
    joints: Query<(Entity, &Joint)>,
    mut forget: Forget,
    mut commands: Commands,
) {
    for (joint, connection) in &joints {
        if connection.objects.contains(&park.entity) {
            commands.entity(joint).insert(Disabled);
        }
    }
    if let Ok(spec) = objects.get(park.entity) {
        forget.object(spec);
    }
}

/// The resources that know of a removed object.
#[derive(SystemParam)]
pub(crate) struct Forget<'w> {
    cause: Res<'w, Cause>,
    index: ResMut<'w, ObjectIndex>,
    facts: MessageWriter<'w, SimFact>,
}

impl Forget<'_> {
    fn object(&mut self, spec: &ObjectSpec) {
        self.index.remove(&spec.id);
        self.facts.write(SimFact::Scene(SceneFact::ObjectDeleted {
            cause: self.cause.0,
            id: spec.id.clone(),
        }));
    }
}

/// Carries out the commands in turn, each on the world that the previous one left.
pub(crate) fn carry_out_commands(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    carry_out(world, reader, |world, cause, command| {
        if let SceneCommand::Edit(edits) = &command {
            edit::check(world, edits)?;
        }
        let mut tables = world.query_filtered::<(), With<Table>>();
        let is_bare = world.resource::<ObjectIndex>().iter().next().is_none();
        let changes_nothing = is_bare && command == SceneCommand::Clear;
        if tables.iter(world).next().is_some() && !changes_nothing {
            begin_change(world, cause);
        }
        match command {
            SceneCommand::Load(path) => {
                let path = path.display();
                return Err(format!(
                    "{path}: nothing here reads task files; add XmlPlugin"
                ));
            }
            SceneCommand::Set(scene) => set_scene(world, &scene),
            SceneCommand::Clear => clear(world),
            SceneCommand::Edit(edits) => edit::carry_out(world, edits),
            SceneCommand::Make { preset, seed } => return preset::make(world, preset, seed),
        }
        Ok(())
    })
}

fn set_scene(world: &mut World, scene: &SceneSpec) {
    clear(world);
    let mut tables = world.query_filtered::<Entity, With<Table>>();
    for table in tables.iter(world).collect::<Vec<_>>() {
        remove_object(world, table);
    }
    renew_if_empty(world);

    let held = world.resource::<ObjectIndex>().ids().map(str::to_owned);
    let mut ids = IdAllocator::with_taken(held);
    let mut assembly = Assembly::on(scene.table);
    let mut members = Vec::new();
    for item in &scene.items {
        let first = assembly.objects.len();
        assembly.add(item, &mut ids);
        members.push((item, first..assembly.objects.len()));
    }
    world.insert_resource(ids);
    world.spawn(assembly.table);
    let mut objects = Vec::new();
    for spec in assembly.objects {
        let object = world.spawn((Transform::from(spec.pose), spec));
        objects.push(object.id());
    }
    let mut compounds = world.resource_mut::<Compounds>();
    for (item, members) in members {
        compounds.note(item, &objects[members]);
    }
    for joint in assembly.joints {
        let index = world.resource::<ObjectIndex>();
        let [first, second] = joint.objects.each_ref().map(|id| index.get(id));
        if let (Some(first), Some(second)) = (first, second) {
            let joint = Joint {
                objects: [first, second],
                frames: joint.frames,
                kind: joint.kind,
                collides: joint.collides,
            };
            world.spawn((joint, ChildOf(second)));
        }
    }
}

/// Removes every object that no hand and no gripper holds.
fn clear(world: &mut World) {
    let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
    for object in objects {
        let object_is = world.entity(object);
        if !object_is.contains::<Held>() {
            remove_object(world, object);
        }
    }
}

pub(crate) fn remove_fallen(
    objects: Query<&Transform, With<ObjectSpec>>,
    index: Res<ObjectIndex>,
    mut commands: Commands,
) {
    for object in index.iter() {
        let Ok(transform) = objects.get(object) else {
            continue;
        };
        if transform.translation.z < LOWEST_Z {
            commands.queue(move |world: &mut World| remove_object(world, object));
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Manipulator, prelude::*};

    use super::*;
    use crate::test_app::test_app;

    fn ball(id: &str) -> ObjectSpec {
        ObjectSpec {
            id: id.into(),
            pose: Pose::at(Vec3::Z),
            mass: 1.0,
            shape: Shape::Sphere {
                radius: 0.5,
                color: Rgb::GRAY,
            },
            dynamics: Default::default(),
            descriptions: Vec::new(),
        }
    }

    fn scene(ids: &[&str]) -> SimCommand {
        SimCommand::Scene(SceneCommand::Set(Box::new(SceneSpec {
            items: ids.iter().map(|id| SceneItem::Object(ball(id))).collect(),
            ..default()
        })))
    }

    fn ids(app: &App) -> Vec<&str> {
        app.world().resource::<ObjectIndex>().ids().collect()
    }

    #[test]
    fn the_last_of_two_scenes_in_a_tick_is_on_the_table() {
        let mut app = test_app();
        app.world_mut().write_command(scene(&["a", "b"]));
        app.world_mut().write_command(scene(&["b", "c"]));
        app.step(1);
        assert_eq!(ids(&app), ["b", "c"]);
        let world = app.world_mut();
        assert_eq!(world.query::<&ObjectSpec>().iter(world).count(), 2);
        assert_eq!(world.query::<&Table>().iter(world).count(), 1);
    }

    #[test]
    fn a_held_object_stays_and_keeps_its_id() {
        let mut app = test_app();
        app.world_mut().write_command(scene(&["a", "b"]));
        app.step(1);
        let held = app.world().resource::<ObjectIndex>().get("a");
        let held = held.unwrap();
        app.world_mut().entity_mut(held).insert(Held {
            by: Manipulator::Hand(Hand::Left),
        });
        app.world_mut().write_command(scene(&["a"]));
        app.step(1);
        assert_eq!(ids(&app), ["a", "a#0"]);
        assert_eq!(app.world().resource::<ObjectIndex>().get("a"), Some(held));
    }

    #[test]
    fn an_object_of_a_scene_names_the_command_that_made_it() {
        let mut app = test_app();
        for command in [scene(&["a"]), SceneCommand::Clear.into()] {
            let id = app.world_mut().write_command(command);
            app.step(1);
            let mut facts = app.world_mut().resource_mut::<Messages<SimFact>>();
            let causes: Vec<_> = facts
                .drain()
                .map(|fact| {
                    let SimFact::Scene(
                        SceneFact::ObjectCreated { cause, .. }
                        | SceneFact::ObjectDeleted { cause, .. },
                    ) = fact
                    else {
                        panic!("{fact:?}");
                    };
                    cause
                })
                .collect();
            assert_eq!(causes, [Some(id)]);
        }
    }

    #[test]
    fn an_object_that_anyone_spawns_or_despawns_is_noted() {
        let mut app = test_app();
        let object = app.world_mut().spawn(ball("mine")).id();
        assert_eq!(ids(&app), ["mine"]);
        app.world_mut().despawn(object);
        assert!(ids(&app).is_empty());
        let facts = app.world().resource::<Messages<SimFact>>();
        let facts: Vec<_> = facts.iter_current_update_messages().collect();
        assert!(matches!(
            facts[..],
            [
                SimFact::Scene(SceneFact::ObjectCreated { .. }),
                SimFact::Scene(SceneFact::ObjectDeleted { .. })
            ]
        ));
    }
}
