//! The process of a script, and those that it starts.

use std::{fs, time::Duration};

use tabletop_engine::EngineError;
use tabletop_harness::test_with;

use super::{config, of_callback, start};
#[cfg(unix)]
use crate::common::executable;
use crate::common::{self, Folder, Session, script_error};

#[cfg(unix)]
#[test_with(Python)]
fn an_interrupt_is_answered_with_its_place_also_in_the_background() {
    let script = of_callback("os.kill(os.getpid(), 2); sum(range(10**7))");
    // A shell makes its background processes ignore interrupts.
    let shell = "#!/bin/sh\ntrap '' INT\nexec python3 \"$@\"\n";
    let (_bin, program) = executable("python-behind", shell);
    let folder = Folder::new(&[("robot.py", &script)]);
    let mut config = config(folder.0.join("robot.py"));
    config.engine.program = program;
    let session = Session::start(config).unwrap();
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest()));
    assert_eq!(
        (error.message.as_str(), error.location().unwrap().line),
        ("KeyboardInterrupt", 4)
    );
}

#[test_with(Python)]
fn processes_of_a_script_know_its_functions() {
    let (_folder, session) = start(
        "import multiprocessing\n\
         def square(x): return x * x\n\
         def init(aux):\n\
         \x20   with multiprocessing.get_context('spawn').Pool(2) as pool:\n\
         \x20       assert pool.map(square, [1, 2, 3]) == [1, 4, 9]\n\
         def callback(sensor, motor, aux): pass\n",
    );
    session.init().unwrap();
}

#[test_with(Python)]
fn a_finally_block_is_not_interrupted() {
    let script = "import os, time\ndef init(aux):\n    try:\n        while True: time.sleep(0.01)\n    finally:\n        time.sleep(0.5)\n\
                  \x20       open(os.path.join(os.path.dirname(__file__), 'done'), 'w').close()\n\
                  def callback(sensor, motor, aux): pass\n";
    let folder = Folder::new(&[("robot.py", script)]);
    let mut config = config(folder.0.join("robot.py"));
    config.timeouts.init = Duration::from_secs(5);
    let session = Session::start(config).unwrap();
    let error = session.init().unwrap_err();
    assert!(matches!(error, EngineError::Timeout { .. }), "{error}");
    assert!(folder.0.join("done").exists());
}

#[test_with(Python)]
fn the_standard_streams_are_the_scripts_own() {
    let (folder, session) = start(
        "import os, subprocess, sys\n\
         def init(aux):\n\
         \x20   sys.stdout = open(aux.path + 'log.txt', 'w')\n\
         \x20   os.dup2(sys.stdout.fileno(), 1)\n\
         def callback(sensor, motor, aux):\n\
         \x20   print('logged', flush=True)\n\
         \x20   subprocess.run(['cat'], check=True)\n\
         \x20   os.close(0)\n",
    );
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap();
    let log = fs::read_to_string(folder.0.join("log.txt")).unwrap();
    assert_eq!(log, "logged\n");
}

#[test_with(Python)]
fn files_beside_the_script_may_have_any_name() {
    let folder = Folder::new(&[
        ("agent.py", "speed = 0.5\n"),
        (
            "robot.py",
            "import agent\n\
             def init(aux): pass\n\
             def callback(sensor, motor, aux): motor.headVelocity = agent.speed\n",
        ),
    ]);
    let session = Session::start(config(folder.0.join("robot.py"))).unwrap();
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.head_velocity, Some(0.5));
}
