//! Edits of single objects: a command's are carried out together, or none of them.

use std::collections::BTreeSet;

use bevy::prelude::*;
use tabletop_core::{Held, Joint, ObjectEdit, ObjectIndex, ObjectSpec};
use tabletop_physics::remove_object;

use crate::{IdAllocator, with_unique_ids};

/// The reason why edits cannot be carried out in turn, if there is one.
pub(crate) fn check(world: &mut World, edits: &[ObjectEdit]) -> Result<(), String> {
    let mut joints = world.query::<&Joint>();
    let joined: BTreeSet<_> = joints.iter(world).flat_map(|joint| joint.objects).collect();
    let index = world.resource::<ObjectIndex>();
    let mut ids: BTreeSet<&str> = index.ids().collect();
    for edit in edits {
        match edit {
            ObjectEdit::Add(_) => {}
            ObjectEdit::Change { object, spec } => {
                let entity = there(world, &ids, object)?;
                if joined.contains(&entity) {
                    return Err(format!(
                        "{object} is connected to another object, and cannot be changed by itself"
                    ));
                }
                ids.remove(object.as_str());
                if spec.id.is_empty() {
                    return Err(format!("{object} needs an id"));
                }
                if !ids.insert(&spec.id) {
                    return Err(format!("the id {} is taken; choose another one", spec.id));
                }
            }
            ObjectEdit::Remove(object) => {
                there(world, &ids, object)?;
                ids.remove(object.as_str());
            }
        }
    }
    Ok(())
}

/// The object of this id, if it is on the table and not held.
fn there(world: &World, ids: &BTreeSet<&str>, id: &str) -> Result<Entity, String> {
    let object = world.resource::<ObjectIndex>().get(id);
    let object = object.filter(|_| ids.contains(id));
    let object = object.ok_or_else(|| format!("there is no object {id}"))?;
    match world.get::<Held>(object) {
        Some(held) => Err(format!("{id} is in {}; release it first", held.by)),
        None => Ok(object),
    }
}

/// Carries out edits that have been [checked](check).
pub(crate) fn carry_out(world: &mut World, edits: Vec<ObjectEdit>) {
    for edit in edits {
        match edit {
            ObjectEdit::Add(spec) => spawn(world, *spec),
            ObjectEdit::Change { object, spec } => {
                remove(world, &object);
                world.resource_mut::<IdAllocator>().take([spec.id.clone()]);
                world.spawn((Transform::from(spec.pose), *spec));
            }
            ObjectEdit::Remove(object) => remove(world, &object),
        }
    }
}

fn remove(world: &mut World, id: &str) {
    if let Some(object) = world.resource::<ObjectIndex>().get(id) {
        remove_object(world, object);
    }
}

/// Puts an object on the table, under a free id.
pub(crate) fn spawn(world: &mut World, spec: ObjectSpec) {
    let others: Vec<_> = world
        .resource::<ObjectIndex>()
        .ids()
        .map(str::to_owned)
        .collect();
    let mut ids = world.resource_mut::<IdAllocator>();
    ids.take(others);
    let spec = with_unique_ids(spec, &mut ids);
    world.spawn((Transform::from(spec.pose), spec));
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Hand, Manipulator, StepApp as _, prelude::*};

    use super::*;
    use crate::test_app::test_app;

    fn ball(id: &str, x: f32) -> ObjectSpec {
        let shape = Shape::Sphere {
            radius: 0.5,
            color: Rgb::GRAY,
        };
        ObjectSpec::new(id, Pose::at(Vec3::new(x, 0.0, 0.5)), 1.0, shape)
    }

    fn add(id: &str, x: f32) -> ObjectEdit {
        ObjectEdit::Add(Box::new(ball(id, x)))
    }

    fn change(object: &str, id: &str, x: f32) -> ObjectEdit {
        ObjectEdit::Change {
            object: object.into(),
            spec: Box::new(ball(id, x)),
        }
    }

    /// Gives edits in a command, and returns the ids on the table, or the refusal.
    fn after(app: &mut App, edits: &[ObjectEdit]) -> Result<Vec<String>, String> {
        app.world_mut().resource_mut::<Messages<SimFact>>().clear();
        app.world_mut()
            .write_command(SceneCommand::Edit(edits.to_vec()));
        app.step(1);
        let facts = app.world().resource::<Messages<SimFact>>();
        let mut cursor = facts.get_cursor();
        let refused = cursor.read(facts).find_map(|fact| {
            if let SimFact::Refused { reason, .. } = fact {
                Some(reason.clone())
            } else {
                None
            }
        });
        match refused {
            Some(reason) => Err(reason),
            None => Ok(app
                .world()
                .resource::<ObjectIndex>()
                .ids()
                .map(str::to_owned)
                .collect()),
        }
    }

    fn ids(ids: &[&str]) -> Result<Vec<String>, String> {
        Ok(ids.iter().map(|&id| id.to_owned()).collect())
    }

    #[test]
    fn objects_are_added_changed_and_removed() {
        let mut app = test_app();
        app.world_mut()
            .write_command(SceneCommand::Set(Box::default()));
        app.step(1);
        let two = [add("a", 0.0), add("a", 3.0)];
        assert_eq!(after(&mut app, &two), ids(&["a", "a#0"]));
        assert_eq!(
            after(&mut app, &[change("a#0", "b", 5.0)]),
            ids(&["a", "b"])
        );
        let moved = app.world().resource::<ObjectIndex>().get("b").unwrap();
        let place = app.world().get::<Transform>(moved).unwrap().translation;
        assert_eq!(place.x, 5.0);
        let swapped = [change("a", "c", 0.0), change("b", "a", 5.0)];
        assert_eq!(after(&mut app, &swapped), ids(&["a", "c"]));
        assert_eq!(
            after(&mut app, &[ObjectEdit::Remove("c".into())]),
            ids(&["a"])
        );
    }

    #[test]
    fn none_of_the_edits_is_made_if_one_cannot_be() {
        let mut app = test_app();
        app.world_mut()
            .write_command(SceneCommand::Set(Box::default()));
        app.step(1);
        after(&mut app, &[add("a", 0.0), add("b", 3.0)]).unwrap();
        for (last, reason) in [
            (change("a", "b", 1.0), "the id b is taken"),
            (change("a", "", 1.0), "a needs an id"),
            (change("z", "y", 1.0), "there is no object z"),
            (ObjectEdit::Remove("z".into()), "there is no object z"),
        ] {
            let refused = after(&mut app, &[add("c", 6.0), last]).unwrap_err();
            assert!(refused.contains(reason), "{refused}");
        }
        let held = app.world().resource::<ObjectIndex>().get("a").unwrap();
        app.world_mut().entity_mut(held).insert(Held {
            by: Manipulator::Hand(Hand::Left),
        });
        let refused = after(&mut app, &[ObjectEdit::Remove("a".into())]).unwrap_err();
        assert!(refused.contains("release it first"), "{refused}");
        assert_eq!(after(&mut app, &[]), ids(&["a", "b"]));
    }
}
