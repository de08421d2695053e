//! Engines that hang, crash or are stopped: each end is reported in time, by its kind.

use std::time::{Duration, Instant};

use tabletop_engine::{EngineError, EngineHandle, Reply, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, PATIENCE, Session, TRIGGERS, octave};

#[test_with(Octave)]
fn an_endless_loop_ends_in_time() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("", "while true, end");
        let mut config = octave(&folder.0, trigger);
        config.timeouts.step = Duration::from_millis(300);
        let session = Session::start(config).unwrap();
        session.init().unwrap();
        let start = Instant::now();
        let error = session.step(&common::at_rest()).unwrap_err();
        assert!(
            matches!(
                error,
                EngineError::Timeout {
                    what: "the callback script",
                    ..
                }
            ),
            "{error}"
        );
        assert!(error.is_fatal());
        assert!(start.elapsed() >= Duration::from_millis(300));
        assert!(
            session.engine.recv_timeout(PATIENCE).is_none(),
            "nothing comes after the end"
        );
    }
}

#[test_with(Octave)]
fn a_running_script_can_be_stopped_from_any_thread() {
    for trigger in TRIGGERS {
        for kill in [EngineHandle::stop, EngineHandle::kill] {
            let folder = Folder::pair("", "while true, end");
            let session = Session::octave(&folder.0, trigger);
            session.init().unwrap();
            session.engine.step(common::at_rest());
            assert!(
                session
                    .engine
                    .recv_timeout(Duration::from_millis(100))
                    .is_none(),
                "the caller does not wait"
            );
            let other = session.engine.clone();
            std::thread::spawn(move || kill(&other)).join().unwrap();
            let reply = session.engine.recv_timeout(PATIENCE);
            assert!(
                matches!(reply, Some(Reply::Failed(EngineError::Stopped))),
                "{reply:?}"
            );
        }
    }
}

#[test_with(Octave)]
fn an_engine_can_be_killed_before_it_has_started() {
    let folder = Folder::pair("", "");
    let engine = EngineHandle::start(octave(&folder.0, Trigger::Stdin)).unwrap();
    engine.kill();
    let reply = engine.recv_timeout(PATIENCE);
    assert!(
        matches!(reply, Some(Reply::Failed(EngineError::Stopped))),
        "{reply:?}"
    );
}

/// Runs a pair until it has failed in the callback.
fn callback_fault(init: &str, callback: &str, trigger: Trigger) -> EngineError {
    let folder = Folder::pair(init, callback);
    let session = Session::octave(&folder.0, trigger);
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap_err()
}

#[test_with(Octave)]
fn a_crash_is_distinguished_from_an_error() {
    for trigger in TRIGGERS {
        let error = callback_fault("", "fprintf(stderr, 'last words\\n'); exit(3)", trigger);
        let EngineError::Died { status, stderr } = &error else {
            panic!("{error}");
        };
        assert!(
            status.contains('3') && stderr.contains("last words"),
            "{error}"
        );
        let error = callback_fault("", "kill(getpid(), 11);", trigger);
        assert!(
            matches!(&error, EngineError::Died { status, .. } if status.contains("11") || status.contains("139")),
            "{error}"
        );
    }
}

#[test_with(Octave)]
fn an_idle_engine_that_ends_is_noticed() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "wait = sprintf('while ! [ -e %sgo ]; do sleep 0.05; done', aux.path); \
             system(sprintf('(%s; kill -9 %d) >/dev/null 2>&1 &', wait, getpid()));",
            "",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        std::fs::write(folder.0.join("go"), "").unwrap();
        let reply = session.engine.recv_timeout(PATIENCE);
        assert!(
            matches!(reply, Some(Reply::Failed(EngineError::Died { .. }))),
            "{reply:?}"
        );
    }
}

#[test_with(Octave)]
fn an_engine_that_cannot_start_says_why() {
    let folder = Folder::pair("", "");
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.working_dir = folder.0.join("nosuch");
    let error = Session::start(config).err().unwrap();
    assert!(error.to_string().contains("no directory"), "{error}");
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.engine.program = "/usr/bin/false".into();
    let error = Session::start(config).err().unwrap();
    assert!(matches!(error, EngineError::Died { .. }), "{error}");
}
