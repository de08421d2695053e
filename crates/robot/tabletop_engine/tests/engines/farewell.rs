//! However a script ends, its files are closed and its cleanup runs.

use std::{fs, path::Path, time::Duration};

use tabletop_engine::{ConsoleLine, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, octave};

const INIT: &str = "fid = fopen([aux.path 'log.txt'], 'w'); fputs(fid, 'written'); \
    farewell = onCleanup(@() disp('farewell'));";

/// The scripts, with their engine after a call of the callback.
fn called(callback: &str, trigger: Trigger) -> (Folder, Session) {
    let folder = Folder::pair(INIT, callback);
    let mut config = octave(&folder.0, trigger);
    if !callback.is_empty() {
        config.timeouts.step = Duration::from_millis(500);
    }
    let session = Session::start(config).unwrap();
    session.init().unwrap();
    drop(session.step(&common::at_rest()));
    (folder, session)
}

/// Output of an engine until it has ended.
fn last_lines(session: &Session) -> Vec<ConsoleLine> {
    while session.engine.is_alive() {
        std::thread::sleep(Duration::from_millis(5));
    }
    session.engine.drain_console()
}

fn log(folder: &Path) -> String {
    fs::read_to_string(folder.join("log.txt")).unwrap()
}

#[test_with(Octave)]
fn after_an_error_or_a_call_that_takes_too_long() {
    let faults = [
        "error('no');",
        "motor.unknown = 1;",
        "while true, end",
        "system('sleep 100');",
    ];
    for trigger in common::TRIGGERS {
        for fault in faults {
            let (folder, session) = called(fault, trigger);
            session.engine.stop();
            let lines = last_lines(&session);
            let reported = |line: &ConsoleLine| line.text == "farewell";
            assert!(lines.iter().any(reported), "{trigger:?} {fault}: {lines:?}");
            assert_eq!(log(&folder.0), "written", "{trigger:?} {fault}");
        }
    }
}

#[test_with(Octave)]
fn after_a_loop_of_programs_that_get_the_interrupts() {
    for fault in [
        "while true, system('true'); end",
        "while true, system('sleep 0.1'); end",
    ] {
        let (folder, session) = called(fault, Trigger::Stdin);
        let lines = last_lines(&session);
        let reported = |line: &ConsoleLine| line.text == "farewell";
        assert!(lines.iter().any(reported), "{fault}: {lines:?}");
        assert_eq!(log(&folder.0), "written", "{fault}");
    }
}

#[test_with(Octave)]
fn when_a_running_call_is_stopped() {
    let (folder, session) = called("", Trigger::Stdin);
    fs::write(
        folder.0.join("testCallback.m"),
        "disp('busy'); while true, end",
    )
    .unwrap();
    session.init().unwrap();
    session.engine.step(common::at_rest());
    assert!(session.printed("busy").contains("busy"));
    session.engine.stop();
    last_lines(&session);
    assert_eq!(log(&folder.0), "written");
}

#[test_with(Octave)]
fn an_end_may_take_a_while_but_not_for_ever() {
    let (folder, session) = called("", Trigger::Stdin);
    let late = format!(
        "late = onCleanup(@() evalin('base', 'pause(1.5); system(\"touch {}\"); disp late'));",
        folder.0.join("late").display()
    );
    fs::write(folder.0.join("testInit.m"), late).unwrap();
    session.init().unwrap();
    session.engine.stop();
    let lines = last_lines(&session);
    assert!(lines.iter().any(|line| line.text == "late"), "{lines:?}");
    assert!(folder.0.join("late").exists());

    let (folder, session) = called("", Trigger::Stdin);
    let never = "never = onCleanup(@() builtin('pause', 1000));";
    fs::write(folder.0.join("testInit.m"), never).unwrap();
    session.init().unwrap();
    session.engine.stop();
    let lines = last_lines(&session);
    let reported =
        |line: &ConsoleLine| line.text.contains("was killed") && line.text.contains("10 s");
    assert!(lines.iter().any(reported), "{lines:?}");
}
