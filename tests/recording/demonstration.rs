//! A simulator that records into a folder of its own.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::{app::PluginGroupBuilder, prelude::*};
use bevy_rapier3d::prelude::{Sleeping, Velocity};
use tabletop::{
    core::{HeadCamera, History, RobotMode},
    geometry::Twist,
    headless_app_with,
    physics::PhysicsSettings,
    prelude::*,
    recorder::{Durability, RecorderPlugin},
    replay::Replay,
    robot::RobotPlugin,
};

/// A folder in memory, where there is one: for hundreds of recordings.
pub fn fresh_folder_in_memory(name: &str) -> PathBuf {
    let memory = Path::new("/dev/shm");
    match memory.is_dir() {
        true => {
            let folder = memory.join(format!("tabletop-{name}-{}", std::process::id()));
            let _not_there = fs::remove_dir_all(&folder);
            folder
        }
        false => fresh_folder(name),
    }
}

/// The folder in which a test records; remains of an earlier run are removed.
pub fn fresh_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _not_there = fs::remove_dir_all(&folder);
    folder
}

/// The replay of a whole recording has the same bytes.
pub fn assert_replays(folder: &Path) {
    assert_eq!(difference_of_replay(folder), None);
}

/// The file in which the replay of a whole recording differs, and the difference.
pub fn difference_of_replay(folder: &Path) -> Option<String> {
    let replay = Replay::read(folder).unwrap();
    assert_eq!(replay.cut_off_at(), None);
    let name = folder.file_name().unwrap().to_string_lossy();
    let replayed = fresh_folder(&format!("{name}_replayed"));
    let recorder = RecorderPlugin {
        folder: replayed.clone(),
        durability: Durability::None,
        ..default()
    };
    replay.record(recorder, replay.camera()).unwrap();
    replay.first_difference(&replayed).unwrap()
}

pub struct Demonstration {
    pub app: App,
    pub folder: PathBuf,
}

impl Demonstration {
    pub fn new(name: &str) -> Self {
        Self::with_physics(name, PhysicsSettings::default())
    }

    pub fn with_physics(name: &str, settings: PhysicsSettings) -> Self {
        let plugins = TabletopSimPlugins.build();
        Self::with(name, plugins.set(PhysicsPlugin { settings }))
    }

    pub fn with_robot(name: &str, mode: RobotMode) -> Self {
        let robot = RobotPlugin { mode, ..default() };
        Self::with(name, TabletopSimPlugins.build().set(robot))
    }

    pub fn with(name: &str, plugins: PluginGroupBuilder) -> Self {
        let folder = fresh_folder(name);
        let recorder = RecorderPlugin {
            folder: folder.clone(),
            ..default()
        };
        let mut app = headless_app_with(plugins.set(recorder));
        app.insert_resource(HeadCamera {
            width: 40,
            height: 30,
            ..default()
        });
        Self { app, folder }
    }

    /// Simulates a tick with these commands.
    pub fn tick(&mut self, commands: &[SimCommand]) {
        self.act(&[(commands.to_vec(), 1)]);
    }

    /// Gives commands, and simulates a number of ticks after each of these acts.
    pub fn act(&mut self, acts: &[(Vec<SimCommand>, u64)]) {
        for (commands, ticks) in acts {
            for command in commands {
                self.app.world_mut().write_command(command.clone());
            }
            self.app.step(*ticks);
        }
    }

    pub fn undoable(&self) -> usize {
        self.app.world().resource::<History>().undoable
    }

    /// Every bit that tells the state of the objects and the robot.
    pub fn bits(&self) -> Vec<(String, Vec<u32>)> {
        bits(&self.app)
    }
}

/// Every bit that tells the state of the objects and the robot.
pub fn bits(app: &App) -> Vec<(String, Vec<u32>)> {
    let world = app.world();
    let tick = world.resource::<SimTick>().0 as u32;
    let objects = world.resource::<ObjectIndex>().iter().map(|object| {
        let place = world.get::<Transform>(object).unwrap();
        let velocity = world.get::<Velocity>(object).unwrap();
        let twist = world.get::<Twist>(object).unwrap();
        assert_eq!(
            (twist.linear, twist.angular),
            (velocity.linear, velocity.angular)
        );
        let numbers = [place.translation, velocity.linear, velocity.angular]
            .into_iter()
            .flat_map(|vector| vector.to_array())
            .chain(place.rotation.to_array())
            .map(f32::to_bits);
        let sleeps = world
            .get::<Sleeping>(object)
            .is_some_and(|state| state.sleeping);
        let id = world.get::<ObjectSpec>(object).unwrap().id.clone();
        (id, numbers.chain([u32::from(sleeps)]).collect())
    });
    let robot = world.resource::<Robot>();
    let joints = robot.joints.iter().flat_map(|joint| {
        let bits = joint.position.to_bits();
        [bits as u32, (bits >> 32) as u32]
    });
    let held = robot.limbs.iter().map(|limb| limb.holds.len() as u32);
    let robot = [u32::from(robot.is_shown)].into_iter().chain(joints);
    std::iter::once(("tick".into(), vec![tick]))
        .chain([("robot".into(), robot.chain(held).collect())])
        .chain(objects)
        .collect()
}
