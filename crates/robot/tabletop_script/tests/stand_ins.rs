//! Without an engine, or with a program that is no engine, the simulation goes on and says so. These tests need no engine.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "engines/kit/mod.rs"]
mod kit;

use std::{fs, os::unix::fs::PermissionsExt as _, time::Duration};

use kit::{Folder, Stage, failure};
use tabletop_core::Agent;
use tabletop_script::EngineChoice;

#[test]
fn without_an_engine_the_message_says_how_to_get_one() {
    let mut settings = Folder::pair("", "").settings();
    settings.engine = Default::default();
    settings.locator.path.clear();
    settings.locator.variable = None;
    settings.locator.root = "/there is nothing".into();
    let mut stage = Stage::start(settings);
    stage.ticks(1);
    assert_eq!(stage.agent(), &Agent::Failed);
    let reason = stage.failure().unwrap();
    assert!(
        reason.starts_with("MATLAB or GNU Octave runs scripts, but neither is there"),
        "{reason}"
    );
    assert!(
        reason.contains("install Octave, which is free, with"),
        "{reason}"
    );
    stage.assert_at_rest();
}

#[test]
fn engines_that_are_none_do_not_keep_the_simulation() {
    let folder = Folder::pair("", "");
    for (text, message) in [
        ("exit 1", "the engine ended (exit status: 1)"),
        (
            "exec >&- 2>&-; exec sleep 1000",
            "no answer from the engine's start within 6 s",
        ),
        (
            "exec sleep 1000",
            "no answer from the engine's start within 6 s",
        ),
        (
            "while read line; do echo \"$line\"; done",
            "no answer from the engine's start within 6 s",
        ),
        (
            "read a; read b; printf '\\001done 1\\n'; exec sleep 1000",
            "reply.bin",
        ),
        (
            "head -c 100000 /dev/urandom; kill -11 $$",
            "the engine ended (signal: 11",
        ),
    ] {
        let program = folder.0.join("no-octave");
        fs::write(&program, format!("#!/bin/sh\n{text}\n")).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let mut settings = folder.settings();
        settings.engine = EngineChoice::Program(program);
        settings.timeouts.start = Duration::from_secs(6);
        let reason = failure(settings);
        assert!(reason.contains(message), "{text}: {reason}");
    }
}
