//! Targets of inputs.

use std::{fs, path::Path};

use bevy::math::DVec3;
use tabletop::{
    core::LayoutFile,
    headless_app_with,
    kinematics::RobotModel,
    mesh::{read_obj, read_stl},
    prelude::*,
    recorder::Session,
    replay::Replay,
    robot::look::read_shape,
    scenario::Scenario,
    script::engine::protocol::Arrays,
};

use crate::scenes;

/// A target: a reader of something that a stranger may have written.
pub struct Target {
    pub name: &'static str,
    /// Starts the target; the returned function takes inputs.
    pub start: fn() -> Box<dyn FnMut(&[u8])>,
    /// What inputs are made of; else they are where chance begins.
    pub material: Option<Material>,
}

/// What inputs are made of.
pub struct Material {
    /// Folders of the repository with files to begin with, besides the target's corpus.
    pub shipped: &'static [&'static str],
    /// Ending of the names of seeds.
    pub ending: &'static str,
    pub dictionary: &'static str,
}

const fn target(
    name: &'static str,
    start: fn() -> Box<dyn FnMut(&[u8])>,
    shipped: &'static [&'static str],
    ending: &'static str,
    dictionary: &'static str,
) -> Target {
    Target {
        name,
        start,
        material: Some(Material {
            shipped,
            ending,
            dictionary,
        }),
    }
}

impl Target {
    pub const ALL: [Self; 11] = [
        target("task", || each(task), &["tablesetup"], ".xml", "task.txt"),
        target(
            "scenario",
            || each(scenario),
            &["scenarios"],
            ".ron",
            "scenario.txt",
        ),
        target("session", || each(session), &[], ".jsonl", "session.txt"),
        target(
            "replay",
            || each(replay),
            &["fuzz/corpus/session"],
            ".jsonl",
            "session.txt",
        ),
        target("urdf", || each(urdf), &["assets"], ".urdf", "urdf.txt"),
        target(
            "layout",
            || each(layout),
            &["assets"],
            ".ron",
            "scenario.txt",
        ),
        target("stl", || each(stl), &[], ".stl", "mesh.txt"),
        target("obj", || each(obj), &[], ".obj", "mesh.txt"),
        target(
            "shape",
            || each(shape),
            &["assets"],
            ".shape.json",
            "session.txt",
        ),
        target("protocol", || each(protocol), &[], ".arrays", "mesh.txt"),
        Self {
            name: "scene",
            start: scenes::start,
            material: None,
        },
    ];

    pub fn named(name: &str) -> Result<&'static Self, String> {
        const TARGETS: &[Target] = &Target::ALL;
        let found = TARGETS.iter().find(|target| target.name == name);
        found.ok_or_else(|| format!("there is no target {name}"))
    }
}

fn each(reader: fn(&[u8])) -> Box<dyn FnMut(&[u8])> {
    Box::new(reader)
}

fn task(bytes: &[u8]) {
    let task = tabletop::xml::parse(Path::new("task.xml"), bytes);
    for fault in &task.faults {
        assert!(!fault.to_string().is_empty(), "a fault says nothing");
    }
}

fn scenario(bytes: &[u8]) {
    let _scenario = Scenario::parse("scenario.ron", &String::from_utf8_lossy(bytes));
}

fn session(bytes: &[u8]) {
    let _session = Session::parse("session.jsonl", &String::from_utf8_lossy(bytes));
}

/// A recording whose session log this is, of which 60 ticks are simulated.
fn replay(bytes: &[u8]) {
    if Session::parse("session.jsonl", &String::from_utf8_lossy(bytes)).is_err() {
        return;
    }
    let folder = std::env::temp_dir().join(format!("tabletop_fuzz_{}", std::process::id()));
    let written = fs::create_dir_all(folder.join("0"))
        .and_then(|()| fs::write(folder.join("session.jsonl"), bytes))
        .and_then(|()| {
            let mut logs = ["0.txt", "states.csv", "joints.csv"].into_iter();
            logs.try_for_each(|log| fs::write(folder.join(log), ""))
        });
    written.expect("a folder for temporary files can be written");
    if let Ok(replay) = Replay::read(&folder) {
        let mut app = headless_app_with(replay.plugins());
        replay.play_in(&mut app);
        app.step(60);
    }
}

/// A description, whose robot then has its weights asked for.
fn urdf(bytes: &[u8]) {
    let Ok(robot) = RobotModel::from_urdf(&String::from_utf8_lossy(bytes)) else {
        return;
    };
    let frames = robot.frames(&robot.zero());
    let _torques = robot.gravity_torques(&frames, DVec3::NEG_Z * 9.81, &[]);
    let _inertia = robot.inertia_matrix(&frames, &[]);
}

fn layout(bytes: &[u8]) {
    if let Ok(file) = LayoutFile::read(&String::from_utf8_lossy(bytes)) {
        let _layout = file.layout(|_| Some([-1.0, 1.0]));
    }
}

fn stl(bytes: &[u8]) {
    let _triangles = read_stl(bytes, 1_000_000);
}

fn obj(bytes: &[u8]) {
    let _triangles = read_obj(bytes, 1_000_000);
}

fn shape(bytes: &[u8]) {
    let _figure = read_shape(&String::from_utf8_lossy(bytes));
}

/// Arrays that are written again if they can be read.
fn protocol(bytes: &[u8]) {
    if let Ok(arrays) = Arrays::decode(bytes) {
        let again = arrays.encode().map(|bytes| Arrays::decode(&bytes));
        assert!(
            matches!(again, Ok(Ok(_))),
            "{arrays:?} cannot be read again"
        );
    }
}
