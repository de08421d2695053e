//! Targets of inputs.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::math::DVec3;
use tabletop::{
    core::{LayoutFile, Picture, Reach, UrdfJoint},
    dataset::import_recording,
    headless_app_with,
    kinematics::RobotModel,
    mesh::{read_collada, read_obj, read_stl},
    prelude::*,
    recorder::{RecordingReader, Session},
    replay::Replay,
    robot::{Description, DescriptionSource, draft, look::read_shape},
    scenario::Scenario,
    script::engine::protocol::Arrays,
    shown_task::shown_task,
    task::{Requirements, Task},
};

use crate::{scenes, sets};

/// A target: a reader of something that a stranger may have written.
pub struct Target {
    pub name: &'static str,
    /// Starts the target; the returned function takes inputs.
    pub start: fn() -> Box<dyn FnMut(&[u8])>,
    /// The material of inputs; without it they are random bytes.
    pub material: Option<Material>,
}

/// The material of inputs.
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

/// A target that is made of the files of its corpus.
const fn of_set(name: &'static str, start: fn() -> Box<dyn FnMut(&[u8])>) -> Target {
    target(name, start, &[], "", "set.txt")
}

impl Target {
    pub const ALL: [Self; 28] = [
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
        target("events", || each(events), &[], ".txt", "recording.txt"),
        target("rows", || each(rows), &[], ".csv", "recording.txt"),
        target("intent", || each(intent), &[], ".json", "recording.txt"),
        target(
            "requirements",
            start_requirements,
            &[],
            ".json",
            "recording.txt",
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
        target("collada", || each(collada), &[], ".dae", "collada.txt"),
        target(
            "shape",
            || each(shape),
            &["assets"],
            ".shape.json",
            "session.txt",
        ),
        target("protocol", || each(protocol), &[], ".arrays", "mesh.txt"),
        of_set("lerobot-info", || sets::lerobot("meta/info.json")),
        of_set("lerobot-stats", || sets::lerobot("meta/stats.json")),
        of_set("lerobot-tasks", || sets::lerobot("meta/tasks.parquet")),
        of_set("lerobot-journal", || sets::lerobot("meta/.commit.json")),
        of_set("lerobot-episodes", || sets::lerobot(sets::EPISODES)),
        of_set("lerobot-frames", || sets::lerobot(sets::FRAMES)),
        of_set("lerobot-video", || sets::lerobot(sets::VIDEO)),
        of_set("rlds-info", || sets::rlds("dataset_info.json")),
        of_set("rlds-features", || sets::rlds("features.json")),
        of_set("rlds-records", || sets::rlds("set-train.tfrecord-00000")),
        of_set("robomimic", sets::robomimic),
        of_set("picture", || each(picture)),
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
    let folder = written(&[
        ("session.jsonl", bytes),
        ("0.txt", b""),
        ("states.csv", b""),
        ("joints.csv", b""),
    ]);
    if let Ok(replay) = Replay::read(&folder) {
        let mut app = headless_app_with(replay.plugins());
        replay.play_in(&mut app);
        app.step(60);
    }
}

/// A folder with these files alone.
fn written(files: &[(&str, &[u8])]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("tabletop_fuzz_{}", std::process::id()));
    let _not_there = fs::remove_dir_all(&folder);
    for (name, bytes) in files {
        let path = folder.join(name);
        let made = path.parent().map_or(Ok(()), fs::create_dir_all);
        made.and_then(|()| fs::write(path, bytes))
            .expect("a folder for temporary files can be written");
    }
    folder
}

/// A recording in which a hand puts one block on another, without its states.
const RECORDING: [(&str, &[u8]); 4] = [
    ("session.jsonl", include_bytes!("recording/session.jsonl")),
    ("0.txt", include_bytes!("recording/0.txt")),
    ("1.txt", include_bytes!("recording/1.txt")),
    ("2.txt", include_bytes!("recording/2.txt")),
];

/// The same with further files.
fn recording_with(files: &[(&str, &[u8])]) -> PathBuf {
    written(&[&RECORDING[..], files].concat())
}

/// Events of a recording of the original program, a blank line between two segments, of which the task is understood. It is imported, and
/// what was imported reads back.
fn events(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let segments = text.split("\n\n").enumerate();
    let named: Vec<_> = segments
        .map(|(number, text)| (format!("{number}.txt"), text.as_bytes()))
        .collect();
    let files: Vec<_> = named.iter().map(|(name, text)| (&**name, *text)).collect();
    let folder = written(&files);
    understand(&folder);
    let imported = folder.with_extension("imported");
    let _not_there = fs::remove_dir_all(&imported);
    if import_recording(&folder, &imported, None).is_ok() {
        Task::read(&imported).expect("an imported recording can be read");
    }
}

/// States of a recording, of which the task is understood; the same bytes as its joints.
fn rows(bytes: &[u8]) {
    let folder = recording_with(&[("states.csv", bytes), ("joints.csv", bytes)]);
    understand(&folder);
    let _joints = RecordingReader::open(&folder).and_then(|recording| recording.joints());
}

fn understand(folder: &Path) {
    if let Ok(task) = Task::read(folder) {
        let shown = shown_task(folder, &task, &Requirements::default(), None);
        let mut steps = shown.steps.iter();
        assert!(steps.all(|step| !step.sentence.is_empty()));
    }
}

/// The unfinished act of a killed program on a recording.
fn intent(bytes: &[u8]) {
    let folder = recording_with(&[
        ("states.csv", b"tick,id\n31,A\n"),
        ("joints.csv", b"tick,joint\n"),
        (".undone/3/session.jsonl", b"{\"segment\":3,\"tick\":60}\n"),
        (".undone/3/states.csv", b""),
        (".undone/3/joints.csv", b""),
        (".undone/3/3.txt", b"4,grasp,LeftHand,A\n"),
        (".intent.json", bytes),
    ]);
    let recording = RecordingReader::open(&folder);
    let _undone = recording.and_then(|recording| recording.undone());
}

/// Requirements on the objects of a task, with which it is told.
fn start_requirements() -> Box<dyn FnMut(&[u8])> {
    let states = include_bytes!("corpus/rows/small.csv");
    let task = Task::read(recording_with(&[("states.csv", states)]));
    let task = task.expect("the recording of the fuzzer can be read");
    Box::new(move |bytes| {
        let folder = written(&[("task.json", bytes)]);
        let _checked = Requirements::read_for(&task, &folder);
        if let Ok(requirements) = Requirements::read(&folder) {
            let mut task = task.clone();
            task.phrase(&requirements);
            let _shown = shown_task(&folder, &task, &requirements, None);
        }
    })
}

/// A description, whose robot then has its weights asked for.
fn urdf(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(robot) = RobotModel::from_urdf(&text) else {
        return;
    };
    let frames = robot.frames(&robot.zero());
    let _torques = robot.gravity_torques(&frames, DVec3::NEG_Z * 9.81, &[]);
    let _inertia = robot.inertia_matrix(&frames, &[]);
    let source = DescriptionSource {
        path: "robot.urdf".into(),
        urdf: text.into_owned(),
        layout: None,
        reach: Some(Reach::of(None::<&Path>)),
    };
    if let Ok(layout) = draft(&source, "robot.urdf") {
        let layout = Some(layout);
        let robot = Description::read(DescriptionSource { layout, ..source });
        let survey = robot.map(|robot| robot.survey());
        assert!(
            matches!(survey, Ok(Ok(_))),
            "what is written loads: {survey:?}"
        );
    }
}

fn layout(bytes: &[u8]) {
    if let Ok(file) = LayoutFile::read(&String::from_utf8_lossy(bytes)) {
        let _layout = file.layout(|name| {
            Some(UrdfJoint {
                name: name.to_owned(),
                slides: false,
                limits: [-1.0, 1.0],
            })
        });
    }
}

fn stl(bytes: &[u8]) {
    let _triangles = read_stl(bytes, 1_000_000);
}

fn obj(bytes: &[u8]) {
    let _triangles = read_obj(bytes, 1_000_000);
}

fn collada(bytes: &[u8]) {
    let _triangles = read_collada(bytes, 1_000_000);
}

fn shape(bytes: &[u8]) {
    let _figure = read_shape(&String::from_utf8_lossy(bytes));
}

fn picture(bytes: &[u8]) {
    if let Ok(picture) = Picture::from_png(bytes) {
        let pixels = picture.width as usize * picture.height as usize;
        assert_eq!(picture.rgb.len(), 3 * pixels);
    }
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
