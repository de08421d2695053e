//! Programs that stand in for engines: their answers cannot harm the program. These tests need no engine.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "engines/common/mod.rs"]
mod common;

use common::{PATIENCE, Session, executable};
use tabletop_engine::{
    EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator, FoundEngine,
    Reply,
};

/// The fault in the answer of a driver whose reply, at `$reply`, these commands make.
fn fault(commands: &str) -> EngineError {
    let text = format!(
        "#!/bin/sh\nreply=\"$1/reply.bin\"\nread -r op number\n{commands}\nprintf '\\001done %s\\n' \"$number\"\nread -r op\n"
    );
    let (_folder, driver) = executable("driver", &text);
    let found = EngineLocator::system().find(&EngineChoice::Driver(driver.clone()));
    let mut config = EngineConfig::new(found.unwrap());
    config.agent = driver;
    config.timeouts = common::patient();
    let engine = EngineHandle::start(config).unwrap();
    match engine.recv_timeout(PATIENCE) {
        Some(Reply::Failed(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_reply_is_a_regular_file_of_a_stated_size() {
    for (commands, reason) in [
        ("mkfifo \"$reply\"", "it is no regular file"),
        ("ln -s /dev/zero \"$reply\"", "it is a link"),
        ("ln -s /etc/hostname \"$reply\"", "it is a link"),
        ("mkdir \"$reply\"", "it is no regular file"),
        ("truncate -s 17G \"$reply\"", "it is too long"),
        (":", "No such file"),
    ] {
        let error = fault(commands).to_string();
        assert!(error.contains(reason), "{commands}: {error}");
    }
}

#[test]
fn a_program_that_is_no_engine_is_reported() {
    let text = "#!/bin/sh\necho licence has expired >&2\nexit 7\n";
    let (_folder, program) = executable("matlab", text);
    let found = EngineLocator::system().find(&EngineChoice::Program(program));
    let error = Session::start(EngineConfig::new(found.unwrap())).err();
    let error = error.unwrap().to_string();
    assert!(
        error.contains('7') && error.contains("licence has expired"),
        "{error}"
    );
}

#[test]
fn an_engine_that_answers_nonsense_is_reported() {
    let text = "#!/bin/sh\nread -r first\nread -r call\nfolder=$(echo \"$call\" | cut -d \"'\" -f 4)\n\
                printf 'TTA1\\1\\0\\0\\0\\377\\377\\377\\377' > \"$folder/reply.bin\"\nprintf '\\001done 1\\n'\nsleep 1000\n";
    let (folder, program) = executable("octave-cli", text);
    let mut config = EngineConfig::new(FoundEngine {
        kind: EngineKind::Octave,
        program,
    });
    config.agent.clone_from(&folder.0);
    config.timeouts = common::patient();
    let error = Session::start(config).err().unwrap();
    assert!(matches!(error, EngineError::Protocol(_)), "{error}");
}

#[test]
fn a_handle_may_be_shared_between_threads() {
    fn shareable<T: Clone + Send + Sync + 'static>() {}
    shareable::<EngineHandle>();
}
