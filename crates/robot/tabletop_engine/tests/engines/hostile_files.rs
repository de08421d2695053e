//! Files that a script leaves in place of its engine's own: they can neither hang the program nor reach other files.

use std::{fs, path::Path, time::Duration};

use tabletop_engine::{
    EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator, Reply,
};
use tabletop_harness::test_with;

use crate::common::{self, Folder, PATIENCE, Session, executable};

fn config(choice: EngineChoice, agent: &Path) -> EngineConfig {
    let mut config = EngineConfig::new(EngineLocator::system().find(&choice).unwrap());
    config.agent = agent.to_owned();
    config.timeouts = common::patient();
    config
}

/// A Python script that puts something in the place of the file of its requests.
fn replaced_request(commands: &str) -> Folder {
    let script = format!(
        "import os, sys\nrequest = os.path.join(sys.argv[1], 'request.bin')\n\
         def init(aux):\n    os.remove(request)\n    {commands}\ndef callback(sensor, motor, aux):\n    pass\n"
    );
    Folder::new(&[("robot.py", &script), ("mine.txt", "mine")])
}

#[test_with(Python)]
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

#[cfg(target_os = "linux")]
#[test_with(Python)]
fn an_engine_that_does_not_read_its_requests_is_ended() {
    // It answers each waiting request, until the pipe of its requests is full.
    let text = "#!/usr/bin/env python3\nimport fcntl, struct, sys, termios\n\
        reply = struct.pack('<4I', 0x31415454, 1, 0, 0)\n\
        open(sys.argv[1] + '/reply.bin', 'wb').write(reply)\n\
        fcntl.fcntl(0, 1031, 4096)\nwaiting = number = 0\nwhile True:\n\
    \x20   there, = struct.unpack('i', fcntl.ioctl(0, termios.FIONREAD, bytes(4)))\n\
    \x20   if there > waiting:\n        waiting, number = there, number + 1\n        print('\\1done %d' % number, flush=True)\n";
    let (_folder, program) = executable("driver", text);
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
