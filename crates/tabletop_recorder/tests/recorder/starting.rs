//! The beginning and the end of a recording, and its folder.

use std::fs;

use tabletop_core::{CommandId, Recording, RecordingCommand, SimCommand, SimFact, StepApp as _};
use tabletop_recorder::Session;

use crate::stage::{Place, app, app_into, heard, run, scene};

#[test]
fn start_and_finish_tell_what_they_do() {
    let place = Place::new();
    let mut app = app(&place);
    let folder = place.demo();
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    let cause = CommandId(0);
    let started = SimFact::RecordingStarted { cause, folder };
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
    let finished = SimFact::RecordingFinished { cause, folder };
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
fn a_recording_whose_folder_cannot_be_made_fails() {
    let mut app = app_into("/dev/null/demo".into());
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    let facts = heard(&mut app);
    let [SimFact::RecordingFailed { folder, reason, .. }] = &facts[..] else {
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

#[test]
fn what_a_starter_left_that_was_killed_is_gone_with_the_next() {
    let place = Place::new();
    let left = place.path().join(".demo.new-1");
    fs::create_dir_all(left.join("0")).unwrap();
    fs::write(left.join("session.jsonl"), "half").unwrap();
    let mut app = app(&place);
    run(&mut app, &[(0, RecordingCommand::Start.into())]);
    assert_eq!(left.exists(), cfg!(not(unix)));
}
