//! Every shipped task file, run.

use std::fs;

use bevy::prelude::*;
use tabletop::{prelude::*, xml::read_task};

#[test]
fn every_shipped_scene_keeps_its_objects_on_the_table() {
    for entry in fs::read_dir("tablesetup").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "xml") {
            continue;
        }
        let mut app = headless_app();
        let scene = read_task(&path).unwrap().scene;
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.step(1);
        let before = app.world().resource::<ObjectIndex>().len();
        app.step(600);
        let world = app.world();
        let index = world.resource::<ObjectIndex>();
        assert_eq!(index.len(), before, "{}", path.display());
        for object in index.iter() {
            let at = world.get::<Transform>(object).unwrap().translation;
            let id = &world.get::<ObjectSpec>(object).unwrap().id;
            assert!(
                at.is_finite() && at.z >= 0.0,
                "{}: {id} is at {at}",
                path.display()
            );
        }
    }
}
