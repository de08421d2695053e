//! The same commands end in the same bits: run again, and with other numbers of ticks a frame.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{path::Path, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_rapier3d::prelude::Velocity;
use tabletop::{prelude::*, xml::read_task};

const TICKS: u64 = 240;
const FILES: [&str; 5] = [
    "chains.xml",
    "cylinders.xml",
    "lidbox-and-block.xml",
    "lidbox.xml",
    "walls.xml",
];

fn command(file: &str) -> SimCommand {
    let path = Path::new("tablesetup").join(file);
    SimCommand::Scene(SceneCommand::Set(Box::new(read_task(&path).unwrap().scene)))
}

/// Every bit of every object's pose and velocity.
fn bits(world: &World) -> Vec<(String, Vec<u32>)> {
    world
        .resource::<ObjectIndex>()
        .iter()
        .map(|object| {
            let pose = world.get::<Transform>(object).unwrap();
            let velocity = world.get::<Velocity>(object).copied().unwrap_or_default();
            let numbers = [pose.translation, velocity.linear, velocity.angular]
                .into_iter()
                .flat_map(|vector| vector.to_array())
                .chain(pose.rotation.to_array());
            let id = world.get::<ObjectSpec>(object).unwrap().id.clone();
            (id, numbers.map(f32::to_bits).collect())
        })
        .collect()
}

fn stepped(file: &str) -> Vec<(String, Vec<u32>)> {
    let mut app = headless_app();
    app.world_mut().write_command(command(file));
    app.step(TICKS);
    bits(app.world())
}

/// In an ordinary Bevy app, as the window is one, with threads and this number of ticks a frame.
fn in_frames(file: &str, ticks_a_frame: u32) -> Vec<(String, Vec<u32>)> {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TabletopSimPlugins));
    app.finish();
    app.cleanup();
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(ticks_a_frame));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::from_secs(1));
    app.update();
    assert_eq!(app.world().resource::<SimTick>().0, 0);
    app.world_mut().write_command(command(file));
    for _ in 0..TICKS / u64::from(ticks_a_frame) {
        app.update();
    }
    assert_eq!(app.world().resource::<SimTick>().0, TICKS);
    bits(app.world())
}

#[test]
fn two_runs_end_in_the_same_bits() {
    for file in FILES {
        let first = stepped(file);
        assert!(!first.is_empty(), "{file} has no objects");
        assert_eq!(first, stepped(file), "{file}");
    }
}

#[test]
fn frames_of_one_and_three_ticks_end_in_the_same_bits() {
    for file in FILES {
        let expected = stepped(file);
        for ticks in [1, 3] {
            assert_eq!(in_frames(file, ticks), expected, "{file}, {ticks} a frame");
        }
    }
}

#[test]
fn a_scene_after_another_ends_in_the_same_bits() {
    for file in FILES {
        let mut app = headless_app();
        app.world_mut().write_command(command("logs.xml"));
        app.step(100);
        app.world_mut().write_command(command(file));
        app.step(TICKS);
        let mut app_again = headless_app();
        app_again.world_mut().write_command(command("logs.xml"));
        app_again.step(100);
        app_again.world_mut().write_command(command(file));
        app_again.step(TICKS);
        assert_eq!(bits(app.world()), bits(app_again.world()), "{file}");
    }
}

/// Anything else in the app: it takes entity ids, as resources do.
#[derive(Resource)]
struct Other<const N: usize>;

#[test]
fn foreign_parts_of_the_app_do_not_matter() {
    for file in FILES {
        let expected = stepped(file);
        let mut app = headless_app();
        app.insert_resource(Other::<0>).insert_resource(Other::<1>);
        app.insert_resource(Other::<2>);
        app.world_mut().spawn(Transform::default());
        app.world_mut().write_command(command(file));
        app.step(TICKS);
        assert_eq!(bits(app.world()), expected, "{file}");
    }
}
