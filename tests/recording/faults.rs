//! Whatever call to the file system fails, and if the program is killed at any of them, what is left of a recording replays.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop::{
    core::HeadCamera,
    headless_app_with,
    prelude::*,
    recorder::{Channels, Durability, Fault, RecorderPlugin, Storage},
    replay::Replay,
};

use crate::demonstration::fresh_folder_in_memory;

/// Commands, and how many ticks to simulate with them.
type Act = (Vec<SimCommand>, u64);

/// A simulator that records into `demo` in this folder.
fn simulator(folder: &Path, storage: Storage) -> App {
    let recorder = RecorderPlugin {
        folder: folder.join("demo"),
        durability: Durability::EveryTick,
        storage,
        ..default()
    };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
    app.insert_resource(HeadCamera {
        width: 4,
        height: 3,
        ..default()
    });
    app
}

fn act(app: &mut App, acts: &[Act]) {
    for (commands, ticks) in acts {
        app.world_mut().write_message_batch(commands.clone());
        app.step(*ticks);
    }
}

/// Has every call fail in every way in turn, each in a recording of these acts, and checks what is left of it.
fn try_every_fault(name: &str, acts: &[Act]) {
    let folder = fresh_folder_in_memory(name);
    let counted = Storage::default();
    act(&mut simulator(&folder, counted.clone()), acts);
    let calls = counted.calls();
    assert!(calls > 100, "{calls}");
    let mut ends = BTreeSet::new();
    for call in 0..calls {
        for fault in Fault::ALL {
            let folder = fresh_folder_in_memory(name);
            // An earlier recording, which must not be lost.
            fs::create_dir_all(folder.join("demo")).unwrap();
            fs::write(folder.join("demo/note"), "earlier").unwrap();
            act(
                &mut simulator(&folder, Storage::with_fault(fault, call)),
                acts,
            );
            let end = check(&folder).unwrap_or_else(|error| {
                panic!("{name}: {fault:?} at call {call} of {calls}: {error}")
            });
            ends.extend(end);
        }
    }
    assert!(ends.len() > 3, "{ends:?}");
}

/// Checks what is left in a folder. Returns where the recording ends.
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
    replay
        .record(replayed.clone(), replay.camera(), Channels::default())
        .map_err(|error| error.to_string())?;
    match replay.first_difference(&replayed) {
        Ok(None) => Ok(Some(replay.recording().last_tick().0)),
        Ok(Some(difference)) => Err(difference),
        Err(error) => Err(error.to_string()),
    }
}

fn grasp(hand: Hand, object: &str) -> SimCommand {
    SimCommand::Grasp {
        hand,
        object: object.into(),
    }
}

fn move_to(hand: Hand, location: (f32, f32, f32)) -> SimCommand {
    SimCommand::MoveTo {
        hand,
        location: location.into(),
    }
}

fn task(file: &str) -> SimCommand {
    SimCommand::LoadTask(PathBuf::from("tablesetup").join(file))
}

#[test]
fn a_recording_with_undo_survives_every_fault() {
    use Hand::{Left, Right};
    try_every_fault(
        "fault_undo",
        &[
            (vec![task("default.xml"), SimCommand::StartRecording], 2),
            (vec![grasp(Right, "RedBlock")], 2),
            (vec![move_to(Right, (-1.5, 0.2, 5.0))], 2),
            (vec![SimCommand::Release(Right)], 2),
            (vec![SimCommand::Undo], 2),
            (vec![SimCommand::Undo], 1),
            (vec![SimCommand::Redo, SimCommand::Redo], 1),
            (vec![SimCommand::Undo, grasp(Left, "GreenBlock")], 2),
            (vec![SimCommand::Undo], 14),
            (vec![SimCommand::FinishRecording], 2),
        ],
    );
}
