//! Files that an engine leaves in place of its own: they can neither hang the program nor fill its memory nor reach other files.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::{fs, os::unix::fs::PermissionsExt as _, path::Path, time::Duration};

use common::{Folder, PATIENCE, Session};
use tabletop_engine::{
    EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator, Reply,
};

fn config(choice: EngineChoice, agent: &Path) -> EngineConfig {
    let mut config = EngineConfig::new(EngineLocator::system().find(&choice).unwrap());
    config.agent = agent.to_owned();
    config.timeouts = common::patient();
    config
}

/// A driver that answers its first request with whatever these commands leave at `$reply`.
fn driver(commands: &str) -> Folder {
    let text = format!(
        "#!/bin/sh\nreply=\"$1/reply.bin\"\nread -r op number\n{commands}\nprintf '\\001done %s\\n' \"$number\"\nread -r op\n"
    );
    let folder = Folder::new(&[("driver", &text)]);
    let executable = fs::Permissions::from_mode(0o755);
    fs::set_permissions(folder.0.join("driver"), executable).unwrap();
    folder
}

fn answer(folder: &Folder) -> EngineError {
    let program = folder.0.join("driver");
    let config = config(EngineChoice::Driver(program.clone()), &program);
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
        let folder = driver(commands);
        let error = answer(&folder).to_string();
        assert!(error.contains(reason), "{commands}: {error}");
    }
}

/// A Python script that puts something in the place of the file of its requests.
fn replaced_request(commands: &str) -> Folder {
    let script = format!(
        "import os, sys\nrequest = os.path.join(sys.argv[1], 'request.bin')\n\
         def init(aux):\n    os.remove(request)\n    {commands}\ndef callback(sensor, motor, aux):\n    pass\n"
    );
    Folder::new(&[("robot.py", &script), ("mine.txt", "mine")])
}

#[test]
fn a_request_goes_to_no_other_file() {
    for (commands, reason) in [
        ("os.mkfifo(request)", "No such device"),
        (
            "os.mkfifo(request); os.open(request, os.O_RDWR)",
            "it is no regular file",
        ),
        (
            "os.symlink(os.path.join(aux.path, 'mine.txt'), request)",
            "it is a link",
        ),
    ] {
        let folder = replaced_request(commands);
        let choice = EngineChoice::Kind(EngineKind::Python);
        let session = Session::start(config(choice, &folder.0.join("robot.py"))).unwrap();
        session.init().unwrap();
        let error = session.step(&common::at_rest()).unwrap_err().to_string();
        assert!(error.contains(reason), "{commands}: {error}");
        let mine = fs::read_to_string(folder.0.join("mine.txt")).unwrap();
        assert_eq!(mine, "mine", "{commands}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_engine_that_does_not_read_its_requests_is_ended() {
    // It answers what it sees waiting, until the pipe of its requests is full.
    let text = "#!/usr/bin/env python3\nimport fcntl, struct, sys, termios\n\
        reply = struct.pack('<4I', 0x31415454, 1, 0, 0)\n\
        open(sys.argv[1] + '/reply.bin', 'wb').write(reply)\n\
        fcntl.fcntl(0, 1031, 4096)\nwaiting = number = 0\nwhile True:\n\
    \x20   there, = struct.unpack('i', fcntl.ioctl(0, termios.FIONREAD, bytes(4)))\n\
    \x20   if there > waiting:\n        waiting, number = there, number + 1\n        print('\\1done %d' % number, flush=True)\n";
    let folder = Folder::new(&[("driver", text)]);
    let program = folder.0.join("driver");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let mut config = config(EngineChoice::Driver(program.clone()), &program);
    config.timeouts.step = Duration::from_millis(100);
    let engine = EngineHandle::start(config).unwrap();
    drop(engine.recv_timeout(PATIENCE));
    engine.init(common::limits());
    let mut steps = 0;
    let error = loop {
        match engine.recv_timeout(PATIENCE) {
            Some(Reply::Failed(error)) => break error,
            Some(_) => engine.step(common::at_rest()),
            None => panic!("no reply after {steps} steps"),
        }
        steps += 1;
    };
    assert!(matches!(error, EngineError::Timeout { .. }), "{error}");
}
