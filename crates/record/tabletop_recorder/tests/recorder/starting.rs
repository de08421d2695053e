//! The beginning and the end of a recording, and its folder.

use std::fs;

use tabletop_core::{
    CommandId, Hand, Recording, RecordingCommand, RecordingFact, SimCommand, SimFact, StepApp as _,
};
use tabletop_recorder::{
    RecorderPlugin, RecordingReport, Session, finish_recording, recording_report,
};
use tabletop_storage::{Storage, StorageFault};

use crate::stage::{Place, app, app_into, app_with, grasp, heard, run, scene};

#[test]
fn start_and_finish_are_reported() {
    let place = Place::new();
    let mut app = app(&place);
    let folder = place.demo();
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    let cause = CommandId(0);
    let started = SimFact::Recording(RecordingFact::Started {
        cause,
        folder,
        moved_aside: None,
    });
    assert_eq!(heard(&mut app), [started]);
    assert!(app.world().resource::<Recording>().0);

    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    let [SimFact::Refused { reason, .. }] = &heard(&mut app)[..] else {
        panic!("a second recording was started");
    };
    assert!(reason.contains("finish it first"), "{reason}");

    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Finish))],
    );
    let folder = place.demo();
    let cause = CommandId(2);
    let finished = SimFact::Recording(RecordingFact::Finished { cause, folder });
    assert_eq!(heard(&mut app), [finished]);
    assert!(!app.world().resource::<Recording>().0);

    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Finish))],
    );
    assert!(matches!(&heard(&mut app)[..], [SimFact::Refused { .. }]));
}

#[test]
fn the_next_recording_leaves_the_last_one_alone() {
    let place = Place::new();
    let mut app = app(&place);
    for id in ["first", "second"] {
        run(
            &mut app,
            &[
                (0, scene(&[id])),
                (1, SimCommand::Recording(RecordingCommand::Start)),
                (1, SimCommand::Recording(RecordingCommand::Finish)),
            ],
        );
    }
    assert!(place.read("0.txt").starts_with("0,create,second,"));
    let aside = fs::read_to_string(place.path().join("demo-1/0.txt")).unwrap();
    assert!(aside.starts_with("0,create,first,"), "{aside}");
}

#[test]
fn nothing_waits_for_the_disk_before_a_recording_is_finished() {
    let place = Place::new();
    let storage = Storage::default();
    let mut app = app_with(RecorderPlugin {
        folder: place.demo(),
        storage: storage.clone(),
        ..RecorderPlugin::default()
    });
    run(
        &mut app,
        &[
            (0, scene(&["block"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(Hand::Left, "block")),
        ],
    );
    assert!(storage.bytes_written() > 0);
    assert_eq!(storage.syncs(), 0);
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Finish))],
    );
    assert!(storage.syncs() > 5, "{}", storage.syncs());
}

#[test]
fn a_recording_whose_folder_cannot_be_made_fails() {
    let mut app = app_into("/dev/null/demo".into());
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    let facts = heard(&mut app);
    let [SimFact::Recording(RecordingFact::Failed { folder, reason, .. })] = &facts[..] else {
        panic!("{facts:?}");
    };
    assert_eq!(*folder, *"/dev/null/demo");
    assert!(reason.contains("/dev/null/demo"), "{reason}");
    assert!(!app.world().resource::<Recording>().0);
    app.step(20);
}

#[cfg(unix)]
#[test]
fn of_several_that_start_at_once_one_gets_the_folder_and_nothing_is_left_of_the_others() {
    let place = Place::new();
    for round in 1..=5 {
        let begin = std::sync::Barrier::new(4);
        let end = std::sync::Barrier::new(4);
        let started: Vec<bool> = std::thread::scope(|scope| {
            let starters: Vec<_> = (0..4)
                .map(|_| {
                    scope.spawn(|| {
                        let mut app = app_into(place.demo());
                        begin.wait();
                        run(&mut app, &[(0, RecordingCommand::Start.into())]);
                        let is_recording = app.world().resource::<Recording>().0;
                        end.wait();
                        is_recording
                    })
                })
                .collect();
            starters
                .into_iter()
                .map(|starter| starter.join().unwrap())
                .collect()
        });
        let count = started.iter().filter(|started| **started).count();
        assert_eq!(count, 1, "round {round}");
        let folders = fs::read_dir(place.path()).unwrap();
        let folders: Vec<_> = folders.map(|entry| entry.unwrap().path()).collect();
        assert_eq!(folders.len(), round, "{folders:?}");
        for folder in folders {
            Session::read(folder.join("session.jsonl")).unwrap();
        }
    }
}

/// Only a folder without a lock stays: one that was just made, whose lock is not locked yet, or that is about to get its name.
#[cfg(unix)]
#[test]
fn leftovers_of_a_killed_starter_are_gone_with_the_next() {
    let mut tried = 0;
    let mut stayed = 0;
    for call in 0.. {
        let place = Place::new();
        let storage = Storage::with_fault(StorageFault::Killed, call);
        let killed = RecorderPlugin {
            folder: place.demo(),
            storage: storage.clone(),
            ..RecorderPlugin::default()
        };
        run(
            &mut app_with(killed),
            &[(0, RecordingCommand::Start.into())],
        );
        if storage.calls() <= call {
            break;
        }
        tried += 1;
        run(&mut app(&place), &[(0, RecordingCommand::Start.into())]);
        let entries = fs::read_dir(place.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        stayed += names.filter(|name| name.starts_with('.')).count();
    }
    assert!(tried > 20, "{tried}");
    assert_eq!(stayed, 3, "of {tried}");
}

/// Files that were open go on elsewhere, and pictures would get into another folder.
#[cfg(unix)]
#[test]
fn a_folder_that_loses_its_place_ends_the_recording() {
    let moved = |place: &Place| fs::rename(place.demo(), place.path().join("moved")).unwrap();
    let replaced = |place: &Place| {
        moved(place);
        fs::create_dir_all(place.demo().join("0")).unwrap();
    };
    let removed = |place: &Place| fs::remove_dir_all(place.demo()).unwrap();
    let displacements: [&dyn Fn(&Place); 3] = [&moved, &replaced, &removed];
    for (number, displace) in displacements.into_iter().enumerate() {
        for ticks in [1, 40] {
            let place = Place::new();
            let mut app = app(&place);
            let start = RecordingCommand::Start.into();
            run(
                &mut app,
                &[(0, scene(&["a"])), (0, start), (2, scene(&["b"]))],
            );
            displace(&place);
            app.step(ticks);
            let error = finish_recording(app.world_mut()).unwrap_err();
            let reason = "was renamed, replaced or removed during the recording";
            assert!(error.contains(reason), "{number} {ticks}: {error}");
            let stays = |name: &str| place.path().join(name).join("session.jsonl").exists();
            assert_eq!(stays("moved"), number < 2);
        }
    }
}

#[test]
fn the_report_names_moved_recordings_and_failures() {
    let place = Place::new();
    let mut app = app(&place);
    assert_eq!(
        finish_recording(app.world_mut()),
        Ok(RecordingReport::default())
    );
    for number in 0..2 {
        run(&mut app, &[(0, RecordingCommand::Start.into())]);
        let report = finish_recording(app.world_mut()).unwrap();
        assert_eq!(report.started, number + 1);
        assert_eq!(report.moved_aside.len(), number);
    }
    let report = recording_report(app.world()).unwrap();
    let aside = place.path().join("demo-1");
    assert_eq!(report.moved_aside[0].to, aside);
    fs::remove_dir_all(place.demo()).unwrap();
    fs::write(place.demo(), "a file").unwrap();
    run(&mut app, &[(0, RecordingCommand::Start.into())]);
    let failure = finish_recording(app.world_mut()).unwrap_err();
    assert!(failure.starts_with("no recording was started"), "{failure}");
}
