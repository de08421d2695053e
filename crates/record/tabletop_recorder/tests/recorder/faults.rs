//! Whichever call to the file system fails, and if the program is killed at any of them, the remains of a recording replay to the
//! same files.

use std::{
    collections::BTreeSet,
    fs::{self, File},
    path::Path,
    thread,
    time::Duration,
};

use bevy::prelude::{App, default};
use tabletop_core::{
    Actor, Hand, HandCommand, HistoryCommand, RecordingCommand, SceneCommand, SimCommand, SimTick,
    StepApp as _, WriteCommand as _,
};
use tabletop_recorder::{
    Channels, Durability, HandPictures, RecorderPlugin, RecordingReader, SessionCommand,
    whole_lines,
};
use tabletop_storage::{Storage, StorageFault};

use crate::stage::{Place, app_with, files_in, grasp, run, scene};

type Script = [(u64, SimCommand)];

const LEFT: Hand = Hand::Left;
const RIGHT: Hand = Hand::Right;
const EVERY_TICK: Durability = Durability::EveryTick;

fn recorder(place: &Place, storage: Storage, durability: Durability) -> App {
    app_with(RecorderPlugin {
        folder: place.demo(),
        durability,
        channels: Channels {
            depth: true,
            ids: false,
        },
        hand_pictures: HandPictures::OfAll,
        storage,
        ..default()
    })
}

/// Has every call fail in every way in turn, each in a recording of this script, and checks the rest of it.
fn try_every_fault(script: &Script) {
    let place = Place::in_memory();
    let counted = Storage::default();
    run(&mut recorder(&place, counted.clone(), EVERY_TICK), script);
    let calls = counted.calls();
    assert!(calls > 100, "only {calls} calls");
    let mut ends = BTreeSet::new();
    for call in 0..calls {
        for fault in StorageFault::ALL {
            let place = Place::in_memory();
            fs::create_dir_all(place.demo()).unwrap();
            let session = place.demo().join("session.jsonl");
            fs::write(session, "{\"format\":4}\n").unwrap();
            fs::write(place.demo().join("note"), "an earlier recording").unwrap();
            run(
                &mut recorder(&place, Storage::with_fault(fault, call), EVERY_TICK),
                script,
            );
            match check(&place) {
                Ok(end) => ends.extend(end),
                Err(problem) => panic!("{fault:?} at call {call} of {calls}: {problem}"),
            }
        }
    }
    assert!(ends.len() > 10, "the recordings end only in {ends:?}");
}

/// Checks the remains of a recording. Returns its last tick, if there is one.
fn check(place: &Place) -> Result<Option<SimTick>, String> {
    let is_earlier = |name: &&str| place.path().join(name).join("note").exists();
    let earlier = ["demo", "demo-1"].into_iter().filter(is_earlier).count();
    if earlier != 1 {
        return Err(format!("the earlier recording is there {earlier} times"));
    }
    if !place.demo().exists() || is_earlier(&"demo") {
        return Ok(None);
    }
    let recording = RecordingReader::open(place.demo()).map_err(|error| error.to_string())?;
    for read in [
        recording.segments().map(drop),
        recording.undone().map(drop),
        recording.states().map(drop),
        recording.joints().map(drop),
    ] {
        read.map_err(|error| error.to_string())?;
    }
    if recording.header().begin_tick.is_none() {
        // An earlier recording came to an untimely end, so its commands are not known.
        return Ok(None);
    }
    let again = Place::in_memory();
    run_again(&recording, &again);
    compare(&place.demo(), &again.demo(), &recording)?;
    Ok(Some(recording.last_tick()))
}

/// Records what a recording holds again, to its end.
fn run_again(recording: &RecordingReader, again: &Place) {
    let mut app = recorder(again, Storage::default(), Durability::None);
    let session = recording.session();
    let start = recording.first_tick();
    let of = |tick: SimTick, command: RecordingCommand| SessionCommand {
        tick: tick.0,
        actor: Actor::App,
        command: command.into(),
        at_once: false,
    };
    let end = recording
        .cut_off_at()
        .map(|tick| of(tick, RecordingCommand::Finish));
    let commands = session
        .earlier
        .iter()
        .cloned()
        .chain([of(start, RecordingCommand::Start)])
        .chain(session.commands.iter().cloned())
        .chain(end);
    for SessionCommand {
        tick,
        actor,
        command,
        ..
    } in commands
    {
        let now = app.world().resource::<SimTick>().0;
        app.step(tick - now);
        app.world_mut().write_command_of(actor, command);
    }
    app.step(1);
}

/// True if the files of a recording, or their beginnings if it was cut off, are those of another.
fn compare(found: &Path, expected: &Path, recording: &RecordingReader) -> Result<(), String> {
    let is_whole = recording.cut_off_at().is_none();
    let is_hidden = |name: &str| name.starts_with('.') || name.ends_with(".part");
    let found: Vec<_> = files_in(found)
        .into_iter()
        .filter(|(name, _)| !is_hidden(name))
        .collect();
    let expected = files_in(expected);
    if is_whole && found.len() != expected.len() {
        return Err(format!("{} files are not {}", found.len(), expected.len()));
    }
    for (name, content) in found {
        let is_empty_folder = name.ends_with('/') && !is_whole;
        let same = match expected.get(&name) {
            Some(expected) if is_whole || name.ends_with(".png") => content == *expected,
            Some(expected) => expected.starts_with(whole_lines(&content)),
            None => is_empty_folder,
        };
        if !same {
            return Err(format!(
                "{name} is\n{}\ninstead of\n{}",
                String::from_utf8_lossy(&content),
                String::from_utf8_lossy(expected.get(&name).unwrap_or(&Vec::new()))
            ));
        }
    }
    Ok(())
}

#[test]
fn a_recording_with_undo_and_redo_survives_every_fault() {
    try_every_fault(&[
        (0, scene(&["a", "bb"])),
        (2, RecordingCommand::Start.into()),
        (2, grasp(RIGHT, "a")),
        (14, HandCommand::Release(RIGHT).into()),
        (1, HistoryCommand::Undo.into()),
        (1, HistoryCommand::Undo.into()),
        (2, HistoryCommand::Redo.into()),
        (0, HistoryCommand::Redo.into()),
        (3, HistoryCommand::Undo.into()),
        (0, grasp(LEFT, "bb")),
        (15, grasp(LEFT, "a")),
        (2, HistoryCommand::Undo.into()),
        (15, HistoryCommand::Redo.into()),
        (2, HistoryCommand::Undo.into()),
        (1, RecordingCommand::Finish.into()),
    ]);
}

#[test]
fn a_recording_of_hand_overs_survives_every_fault() {
    try_every_fault(&[
        (0, scene(&["a", "bb"])),
        (0, RecordingCommand::Start.into()),
        (2, grasp(RIGHT, "a")),
        (1, grasp(LEFT, "a")),
        (3, HistoryCommand::Undo.into()),
        (16, HandCommand::Destroy(LEFT).into()),
        (1, RecordingCommand::Finish.into()),
    ]);
}

#[test]
fn a_recording_of_another_scene_survives_every_fault() {
    try_every_fault(&[
        (0, scene(&["a", "bb"])),
        (2, RecordingCommand::Start.into()),
        (7, scene(&["ccc", "bb"])),
        (3, grasp(RIGHT, "ccc")),
        (7, SceneCommand::Clear.into()),
        (7, RecordingCommand::Finish.into()),
    ]);
}

#[test]
fn a_second_recording_survives_every_fault_and_the_first_is_kept() {
    try_every_fault(&[
        (0, scene(&["a"])),
        (2, RecordingCommand::Start.into()),
        (2, grasp(RIGHT, "a")),
        (2, RecordingCommand::Finish.into()),
        (2, RecordingCommand::Start.into()),
        (2, HandCommand::Release(RIGHT).into()),
        (1, HistoryCommand::Undo.into()),
        (16, RecordingCommand::Finish.into()),
    ]);
}

/// A process that is being started has the files of the program that starts it, with their locks, until it is another program.
#[cfg(unix)]
#[test]
fn an_undo_that_was_interrupted_is_finished_though_the_log_is_locked_for_a_moment() {
    let script = [
        (0, scene(&["a"])),
        (0, RecordingCommand::Start.into()),
        (2, grasp(RIGHT, "a")),
        (2, HistoryCommand::Undo.into()),
    ];
    let mut interrupted = 0;
    for call in 0.. {
        let place = Place::in_memory();
        let storage = Storage::with_fault(StorageFault::Killed, call);
        run(&mut recorder(&place, storage.clone(), EVERY_TICK), &script);
        if storage.calls() <= call {
            break;
        }
        let intent = place.demo().join(".intent.json");
        if !intent.exists() {
            continue;
        }
        interrupted += 1;
        let held = File::open(place.demo().join("session.jsonl")).unwrap();
        held.lock().unwrap();
        thread::scope(|scope| {
            scope.spawn(move || {
                thread::sleep(Duration::from_millis(30));
                drop(held);
            });
            RecordingReader::open(place.demo()).unwrap();
        });
        assert!(!intent.exists(), "killed at call {call}");
    }
    assert!(interrupted > 3, "interrupted only {interrupted} times");
}
