//! Whichever call to the file system fails, and if the program is killed at any of them, the remains of a recording replay.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop::{
    core::{Drive, HeadCamera},
    headless_app_with,
    prelude::*,
    recorder::{Durability, RecorderPlugin},
    replay::Replay,
    storage::{Storage, StorageFault},
};

use crate::demonstration::fresh_folder_in_memory;

fn small_camera() -> HeadCamera {
    HeadCamera {
        width: 4,
        height: 3,
        ..default()
    }
}

/// Commands, and the number of ticks to simulate with them.
type Act = (Vec<SimCommand>, u64);

/// The calls that are made to fail: every n-th from this one on.
#[derive(Clone, Copy)]
struct Calls {
    first: usize,
    step: usize,
}

const ALL: Calls = Calls { first: 0, step: 1 };

/// The recorder that keeps a recording in `demo` in this folder.
fn recorder(folder: &Path, storage: Storage) -> RecorderPlugin {
    RecorderPlugin {
        folder: folder.join("demo"),
        durability: Durability::EveryTick,
        storage,
        ..default()
    }
}

fn record(acts: &[Act], recorder: RecorderPlugin) {
    let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
    app.insert_resource(small_camera());
    for (commands, ticks) in acts {
        for command in commands {
            app.world_mut().write_command(command.clone());
        }
        app.step(*ticks);
    }
}

/// Makes calls fail in every way in turn, each in a new recording, and checks the remains.
fn try_faults(name: &str, calls: Calls, record: impl Fn(RecorderPlugin)) {
    let folder = fresh_folder_in_memory(name);
    let counted = Storage::default();
    record(recorder(&folder, counted.clone()));
    let count = counted.calls();
    assert!(count > 100, "{count}");
    let mut ends = BTreeSet::new();
    for call in (0..count).skip(calls.first).step_by(calls.step) {
        for fault in StorageFault::ALL {
            let folder = fresh_folder_in_memory(name);
            // An earlier recording, which must not be lost.
            fs::create_dir_all(folder.join("demo")).unwrap();
            fs::write(folder.join("demo/session.jsonl"), "{\"format\":4}\n").unwrap();
            fs::write(folder.join("demo/note"), "earlier").unwrap();
            record(recorder(&folder, Storage::with_fault(fault, call)));
            match check(&folder) {
                Ok(end) => ends.extend(end),
                Err(problem) => panic!("{name}: {fault:?} at call {call} of {count}: {problem}"),
            }
        }
    }
    let least = if calls.step == 1 { 4 } else { 1 };
    assert!(ends.len() >= least, "{ends:?}");
    fs::remove_dir_all(folder).unwrap();
}

/// Checks the remains in a folder. Returns the end of the recording.
fn check(folder: &Path) -> Result<Option<u64>, String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .map_err(|error| error.to_string())?
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let is_earlier = |name: &str| folder.join(name).join("note").exists();
    if names.iter().filter(|name| is_earlier(name)).count() != 1 {
        return Err(format!("the earlier recording is not in {names:?}"));
    }
    let demo = folder.join("demo");
    if !demo.exists() || is_earlier("demo") {
        return Ok(None);
    }
    let replayed = folder.join("replayed");
    let replay = Replay::read(&demo).map_err(|error| error.to_string())?;
    let recorder = RecorderPlugin {
        folder: replayed.clone(),
        durability: Durability::None,
        ..default()
    };
    replay
        .record(recorder, replay.camera())
        .map_err(|error| error.to_string())?;
    match replay.first_difference(&replayed) {
        Ok(None) => Ok(Some(replay.recording().last_tick().0)),
        Ok(Some(difference)) => Err(difference),
        Err(error) => Err(error.to_string()),
    }
}

fn grasp(hand: Hand, object: &str) -> SimCommand {
    HandCommand::Grasp {
        hand,
        object: object.into(),
    }
    .into()
}

fn move_to(hand: Hand, location: (f32, f32, f32)) -> SimCommand {
    HandCommand::MoveTo {
        hand,
        location: location.into(),
    }
    .into()
}

fn task(file: &str) -> SimCommand {
    SceneCommand::Load(PathBuf::from("tablesetup").join(file)).into()
}

fn drive(joint: RobotJoint, speed: f64) -> SimCommand {
    RobotCommand::drive([(joint, Drive::Velocity(speed))]).into()
}

fn with_undo(calls: Calls) {
    use Hand::{Left, Right};
    let acts = [
        (vec![task("default.xml"), RecordingCommand::Start.into()], 2),
        (vec![grasp(Right, "RedBlock")], 2),
        (vec![move_to(Right, (-1.5, 0.2, 5.0))], 2),
        (vec![HandCommand::Release(Right).into()], 2),
        (vec![HistoryCommand::Undo.into()], 2),
        (vec![HistoryCommand::Undo.into()], 1),
        (
            vec![HistoryCommand::Redo.into(), HistoryCommand::Redo.into()],
            1,
        ),
        (
            vec![HistoryCommand::Undo.into(), grasp(Left, "GreenBlock")],
            2,
        ),
        (vec![HistoryCommand::Undo.into()], 14),
        (vec![RecordingCommand::Finish.into()], 2),
    ];
    try_faults("fault_undo", calls, |recorder| record(&acts, recorder));
}

fn with_the_robot(calls: Calls) {
    let acts = [
        (
            vec![task("default.xml"), RobotCommand::Show(true).into()],
            2,
        ),
        (vec![RecordingCommand::Start.into()], 2),
        (vec![drive(RobotJoint::LeftS1, 0.5)], 10),
        (vec![grasp(Hand::Any, "RedBlock")], 2),
        (vec![drive(RobotJoint::RightE1, -0.5)], 5),
        (vec![RecordingCommand::Finish.into()], 1),
    ];
    try_faults("fault_robot", calls, |recorder| record(&acts, recorder));
}

fn with_another_scene(calls: Calls) {
    let acts = [
        (vec![task("default.xml"), RecordingCommand::Start.into()], 9),
        (vec![task("lidbox.xml")], 9),
        (vec![ClockCommand::SetPaused(true).into()], 1),
        (vec![SceneCommand::Clear.into()], 1),
        (vec![ClockCommand::SetPaused(false).into()], 5),
        (vec![RecordingCommand::Finish.into()], 1),
    ];
    try_faults("fault_scene", calls, |recorder| record(&acts, recorder));
}

/// The replay of a script: a command in every tick. It makes the same calls as the recording.
fn with_a_script(calls: Calls) {
    let place = fresh_folder_in_memory("fault_script_once");
    let joints = RobotJoint::of_arm(Arm::Left).map(|joint| (joint, Drive::Velocity(0.2)));
    let call = (vec![RobotCommand::drive(joints).into()], 1);
    let mut acts = vec![(vec![task("default.xml"), RecordingCommand::Start.into()], 1)];
    acts.extend(vec![call; 20]);
    acts.push((vec![RecordingCommand::Finish.into()], 1));
    record(&acts, recorder(&place, Storage::default()));
    let replay = Replay::read(place.join("demo")).unwrap();
    try_faults("fault_script", calls, |recorder| {
        // A recording that fails ends the replay, too.
        let _ = replay.record(recorder, replay.camera());
    });
    fs::remove_dir_all(place).unwrap();
}

/// Of every recording some calls, others for each.
#[test]
fn recordings_survive_faults() {
    with_undo(Calls { first: 3, step: 41 });
    with_the_robot(Calls { first: 7, step: 61 });
    with_another_scene(Calls {
        first: 11,
        step: 61,
    });
    with_a_script(Calls { first: 5, step: 61 });
}

#[test]
#[ignore = "takes some minutes"]
fn a_recording_with_undo_survives_every_fault() {
    with_undo(ALL);
}

#[test]
#[ignore = "takes some minutes"]
fn a_recording_with_the_robot_survives_every_fault() {
    with_the_robot(ALL);
}

#[test]
#[ignore = "takes some minutes"]
fn a_recording_with_another_scene_survives_every_fault() {
    with_another_scene(ALL);
}

#[test]
#[ignore = "takes some minutes"]
fn a_recording_with_a_script_survives_every_fault() {
    with_a_script(ALL);
}
