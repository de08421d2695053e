//! Python as an engine, with a real python3.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::{
    fs,
    path::{self, PathBuf},
    time::Duration,
};

use common::{Folder, Session, script_error};
use tabletop_engine::{
    EngineChoice, EngineConfig, EngineError, EngineKind, EngineLocator, RgbImage, SensedContact,
    SensedObject, Sensor,
};

fn config(file: PathBuf) -> EngineConfig {
    let found = EngineLocator::system().find(&EngineChoice::Kind(EngineKind::Python));
    let found = found.unwrap_or_else(|error| panic!("these tests need python3: {error}"));
    let mut config = EngineConfig::new(found);
    config.agent = file;
    config.timeouts = common::patient();
    config
}

fn start(script: &str) -> (Folder, Session) {
    let folder = Folder::new(&[("robot.py", script)]);
    let session = Session::start(config(folder.0.join("robot.py"))).unwrap();
    (folder, session)
}

#[test]
fn the_example_turns_every_joint() {
    let root = path::absolute("../..").unwrap();
    let mut config = config("python/example.py".into());
    config.working_dir = root;
    let session = Session::start(config).unwrap();
    assert!(
        session.description.starts_with("Python 3"),
        "{}",
        session.description
    );
    let reply = session.init().unwrap();
    assert_eq!(reply.draw_markers.len(), 4);
    assert_eq!(
        reply.init_joint_angles.unwrap()[1][2],
        std::f64::consts::FRAC_PI_2
    );
    let sensor = Sensor {
        time_elapsed: 3.0,
        ..common::at_rest()
    };
    let speed = || session.step(&sensor).unwrap().motor.joint_velocities;
    assert_eq!(
        [speed(), speed(), speed()],
        [[[0.5; 7]; 2], [[0.5; 7]; 2], [[-0.5; 7]; 2]]
    );
    assert!(session.printed("jointAngles").contains("sensed: "));
}

#[test]
fn everything_that_is_sensed_arrives() {
    let (_folder, session) = start(
        "import os\n\
         def init(aux):\n    assert aux.numLimbs == 2 and aux.maxJointAngles[1][3] == 2.618 and aux.path.endswith('/'), vars(aux)\n\
         def callback(sensor, motor, aux):\n\
         \x20   assert abs(sensor.rgbVision[1, 2][0] - 0.2) < 1e-12\n\
         \x20   assert sensor.trackerLoc['l-S1'][2] == 3 and sensor.demoCue is True\n\
         \x20   assert sensor.objects.id == ['a', 'b'] and sensor.objects.position[1][0] == 7\n\
         \x20   motor.jointVelocities[1][2] = sensor.jointAngles[1][6]\n\
         \x20   motor.gripperVelocities = [1, -1]\n",
    );
    session.init().unwrap();
    let mut rgb = vec![0; 18];
    rgb[15] = 51;
    let mut sensor = Sensor {
        picture: RgbImage::new(3, 2, rgb),
        demo_cue: true,
        ..common::at_rest()
    };
    sensor.tracker_loc = Some(vec![("l-S1".into(), [1.0, 2.0, 3.0])]);
    sensor.joint_angles[1][6] = 0.75;
    let b = SensedObject {
        id: "b".into(),
        position: [7.0, 0.0, 0.0],
        ..SensedObject::default()
    };
    sensor.objects = Some(vec![
        SensedObject {
            id: "a".into(),
            ..b.clone()
        },
        b,
    ]);
    let motor = session.step(&sensor).unwrap().motor;
    assert_eq!(
        (motor.joint_velocities[1][2], motor.gripper_velocities),
        (0.75, vec![1.0, -1.0])
    );
}

/// A script with an init that does nothing, and a callback of this line.
fn of_callback(line: &str) -> String {
    format!("import os, sys\ndef init(aux): pass\ndef callback(sensor, motor, aux):\n    {line}\n")
}

#[test]
fn columns_are_lists_of_any_length_and_counts_are_whole() {
    let (_folder, session) = start(
        "def init(aux): assert list(range(aux.numLimbs)) == [0, 1] and aux.numJoints == 7\n\
         def callback(sensor, motor, aux):\n\
         \x20   assert list(sensor.objects.mass) == [2.0] * len(sensor.objects.id), sensor.objects.mass\n\
         \x20   assert list(sensor.contacts.impulse) == [0.5] * len(sensor.contacts.first), sensor.contacts.impulse\n\
         \x20   assert len(sensor.objects.position) == len(sensor.objects.id)\n",
    );
    session.init().unwrap();
    let object = SensedObject {
        mass: 2.0,
        ..SensedObject::default()
    };
    let contact = SensedContact {
        impulse: 0.5,
        ..SensedContact::default()
    };
    for count in 0..4 {
        let sensor = Sensor {
            objects: Some(vec![object.clone(); count]),
            contacts: Some(vec![contact.clone(); count]),
            ..common::at_rest()
        };
        session.step(&sensor).unwrap();
    }
}

#[test]
fn truth_values_are_numbers() {
    let (_folder, session) = start(&of_callback(
        "motor.headVelocity = True; motor.gripperVelocities = [True, False]",
    ));
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.head_velocity, Some(1.0));
    assert_eq!(motor.gripper_velocities, [1.0, 0.0]);
}

#[test]
fn a_file_that_python_cannot_read_is_named_once() {
    let folder = Folder::new(&[("robot.py", ""), ("helper.py", "x = (\n")]);
    let robot = folder.0.join("robot.py");
    let session = Session::start(config(robot.clone())).unwrap();
    let functions = of_callback("pass");
    for (text, places) in [
        (format!("{functions}x = = 3\n"), &["robot.py:5"][..]),
        (format!("{functions}zero = '\0'\n"), &["robot.py"]),
        (
            format!("import helper\n{functions}"),
            &["helper.py:1", "robot.py:1"],
        ),
    ] {
        fs::write(&robot, text).unwrap();
        let error = script_error(session.init());
        assert!(!error.message.contains('\n'), "{}", error.message);
        let found: Vec<_> = error.stack.iter().map(ToString::to_string).collect();
        let places = places.iter().map(|place| folder.0.join(place));
        let places: Vec<_> = places.map(|place| place.display().to_string()).collect();
        assert_eq!(found, places);
    }
}

#[test]
fn what_led_to_an_error_is_told() {
    let (folder, session) = start(
        "def init(aux): pass\n\
         def callback(sensor, motor, aux):\n\
         \x20   try: {}['hand']\n\
         \x20   except KeyError as error: raise RuntimeError('no plan') from error\n",
    );
    session.init().unwrap();
    let robot = folder.0.join("robot.py").display().to_string();
    let reported = |link: &str, error: &str| {
        format!("{error}\n{link} KeyError: 'hand' ({robot}:3)\n  at {robot}:4")
    };
    let error = session.step(&common::at_rest()).unwrap_err();
    assert_eq!(
        error.to_string(),
        reported("because of", "RuntimeError: no plan")
    );
    let text = fs::read_to_string(&robot).unwrap();
    fs::write(&robot, text.replace(" from error", "")).unwrap();
    session.init().unwrap();
    let error = session.step(&common::at_rest()).unwrap_err();
    assert_eq!(
        error.to_string(),
        reported("while handling", "RuntimeError: no plan")
    );
}

#[test]
fn the_errors_of_a_group_are_told() {
    let (folder, session) = start(
        "class Group(Exception):\n\
         \x20   exceptions = (ValueError('no ball'), 7, KeyError('hand'))\n\
         def init(aux): raise Group('two tasks')\n\
         def callback(sensor, motor, aux): pass\n",
    );
    let robot = folder.0.join("robot.py").display().to_string();
    assert_eq!(
        session.init().unwrap_err().to_string(),
        format!(
            "Group: two tasks\none of them: ValueError: no ball\none of them: KeyError: 'hand'\n  at {robot}:3"
        )
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_is_answered_with_its_place_also_in_the_background() {
    use std::os::unix::fs::PermissionsExt as _;
    let script = of_callback("os.kill(os.getpid(), 2); sum(range(10**7))");
    // A shell has what it starts in the background ignore interrupts.
    let shell = "#!/bin/sh\ntrap '' INT\nexec python3 \"$@\"\n";
    let folder = Folder::new(&[("robot.py", &script), ("python-behind", shell)]);
    let mut config = config(folder.0.join("robot.py"));
    config.engine.program = folder.0.join("python-behind");
    fs::set_permissions(&config.engine.program, fs::Permissions::from_mode(0o755)).unwrap();
    let session = Session::start(config).unwrap();
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest()));
    assert_eq!(
        (error.message.as_str(), error.location().unwrap().line),
        ("KeyboardInterrupt", 4)
    );
}

#[test]
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

#[test]
fn a_misused_aux_names_the_script_and_a_typo_is_noted() {
    let script =
        |line: &str| format!("def init(aux): {line}\ndef callback(sensor, motor, aux): pass\n");
    let (folder, session) = start(&script("aux.drawMarkers = [[1, 2, 3], [0, -1e39, 0]]"));
    let message = format!(
        "aux.drawMarkers[1][1] is -1e39; it must be between -1e6 and 1e6\n  at {}",
        folder.0.join("robot.py").display()
    );
    assert_eq!(session.init().unwrap_err().to_string(), message);
    let (_folder, session) = start(&script("aux.drawMarker = [[1, 2, 3]]; aux.plan = []"));
    session.init().unwrap();
    let note = "tabletop: aux.drawMarker means nothing (did you mean drawMarkers?)\n";
    assert_eq!(session.printed("drawMarkers"), note);
    let (_folder, session) = start(
        "def init(aux): aux.Exit = 1\ndef callback(sensor, motor, aux): aux.exits = True; aux.mine = 1\n",
    );
    session.init().unwrap();
    for _ in 0..2 {
        session.step(&common::at_rest()).unwrap();
    }
    let notes = "tabletop: aux.Exit means nothing (did you mean exit?)\ntabletop: aux.exits means nothing (did you mean exit?)\n";
    assert_eq!(session.printed("exits"), notes);
}

#[test]
fn what_is_too_large_is_told_by_its_size() {
    let (folder, session) = start("def init(aux): pass\ndef callback(sensor, motor, aux): pass\n");
    let reported = |line: &str| {
        let script =
            format!("def init(aux): pass\ndef callback(sensor, motor, aux):\n    {line}\n");
        fs::write(folder.0.join("robot.py"), script).unwrap();
        session.init().unwrap();
        let error = session.step(&common::at_rest()).unwrap_err();
        assert!(!error.is_fatal(), "{error}");
        error.to_string()
    };
    let error = reported("raise ValueError('x' * 70_000_000)");
    assert!(error.starts_with("ValueError: xxx"), "{}", error.len());
    let error = reported("motor.jointVelocities = [[0.0] * 3000] * 3000");
    assert!(error.contains("is 3000x3000 double"), "{error}");
    // So much that nobody can look at all of it.
    let error = reported("motor.jointVelocities = [range(10**12)] * 2");
    assert!(error.contains("is 2x4294967295 double"), "{error}");
}

#[test]
fn a_row_of_a_column_may_be_a_number() {
    let (_folder, session) = start(
        "def init(aux): pass\n\
         def callback(sensor, motor, aux): motor.gripperVelocities = [[0.0], [0.5]]; motor.gripperVelocities[0] = -1.0\n",
    );
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.gripper_velocities, [-1.0, 0.5]);
}

#[test]
fn faults_are_told_with_their_place() {
    let (folder, session) = start(
        "def init(aux): pass\ndef callback(sensor, motor, aux):\n    helper()\ndef helper():\n    1 / 0\n",
    );
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest()));
    assert_eq!(
        (error.id.as_str(), error.message.as_str()),
        ("ZeroDivisionError", "ZeroDivisionError: division by zero")
    );
    let lines: Vec<_> = error.stack.iter().map(|place| place.line).collect();
    assert_eq!(
        (lines, &error.location().unwrap().file),
        (vec![5, 3], &folder.0.join("robot.py"))
    );
    fs::write(folder.0.join("robot.py"), "def init(aux):\n  x = = 3\n").unwrap();
    let error = script_error(session.init());
    assert_eq!(
        error.location().unwrap().to_string(),
        format!("{}:2", folder.0.join("robot.py").display())
    );
    for (callback, message) in [
        (
            "motor.jointVelocities = [[0] * 7] * 3",
            "motor.jointVelocities is 3x7 double; it must be 2x7",
        ),
        (
            "motor.jointVelocities = [[0] * 7, [0]]",
            "motor.jointVelocities is 2x1 ragged list with rows of 1 to 7 elements; it must be 2x7 double",
        ),
        (
            "motor.jointVelocities = [[1j] * 7] * 2",
            "motor.jointVelocities is 2x7 complex; it must be 2x7 double",
        ),
        (
            "motor.jointVelocities = [[(1, 2)] * 7] * 2",
            "motor.jointVelocities is 2x7x2 double; it must be 2x7",
        ),
        (
            "v = [0]; v.append(v); motor.gripperVelocities = v",
            "motor.gripperVelocities is 2x1 ragged list",
        ),
        (
            "motor.headVelocity = -10**400",
            "motor.headVelocity is -Inf; it must be a finite number",
        ),
        (
            "setattr(motor, 'größe', 1)",
            "motor.gr__e is no field that the robot knows",
        ),
        (
            "motor.headVelocity = None",
            "motor.headVelocity is 1x1 NoneType; it must be 1x1 double",
        ),
        (
            "motor.headVelocity = float('nan')",
            "motor.headVelocity is NaN; it must be a finite number",
        ),
        (
            "motor.jointVelocities[1][2] = float('nan')",
            "motor.jointVelocities[1][2] is NaN; it must be a finite number\n  at ",
        ),
        (
            "motor.gripperVelocities = [0, float('inf')]",
            "motor.gripperVelocities[1] is Inf; it must be a finite number",
        ),
        (
            "motor.spin = 1",
            "motor.spin is no field that the robot knows",
        ),
        ("input()", "EOFError"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt\n  at "),
        (
            "sys.exit('bye')",
            "SystemExit: bye; to end the script, set aux.exit\n  at ",
        ),
    ] {
        fs::write(folder.0.join("robot.py"), of_callback(callback)).unwrap();
        session.init().unwrap();
        let error = session.step(&common::at_rest()).unwrap_err();
        assert!(
            !error.is_fatal() && error.to_string().starts_with(message),
            "{callback}: {error}"
        );
    }
}

#[test]
fn what_a_script_does_at_last_is_not_interrupted() {
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

#[test]
fn hangs_exits_and_missing_files_are_told() {
    let script = |init: &str| {
        format!("import os\ndef init(aux):\n    {init}\ndef callback(sensor, motor, aux): pass\n")
    };
    let folder = Folder::new(&[("robot.py", &script("while True: pass"))]);
    let mut config = config(folder.0.join("robot.py"));
    config.timeouts.init = Duration::from_secs(5);
    let session = Session::start(config.clone()).unwrap();
    let error = session.init().unwrap_err();
    assert!(matches!(error, EngineError::Timeout { .. }), "{error}");
    assert!(error.to_string().ends_with("robot.py:3"), "{error}");
    fs::write(folder.0.join("robot.py"), script("os._exit(3)")).unwrap();
    let session = Session::start(config.clone()).unwrap();
    let error = session.init().unwrap_err();
    assert!(
        matches!(&error, EngineError::Died { status, .. } if status.contains('3')),
        "{error}"
    );
    config.agent = folder.0.join("nosuch.py");
    let session = Session::start(config).unwrap();
    assert!(script_error(session.init()).message.contains("nosuch.py"));
    let exit =
        "def init(aux): aux.exit = False\ndef callback(sensor, motor, aux): aux.exit = None\n";
    let (_folder, session) = start(exit);
    let reply = session.init().unwrap();
    assert_eq!((reply.init_joint_angles, reply.exit), (None, true));
    assert!(session.step(&common::at_rest()).unwrap().exit);
}

#[test]
fn what_is_no_script_is_told() {
    let callback = "def callback(sensor, motor, aux): pass\n";
    for (name, text, message) in [
        (
            "a.py",
            "def init(aux): pass\n".to_owned(),
            "{} has no function callback(sensor, motor, aux)",
        ),
        (
            "b.py",
            format!("init = 3\n{callback}"),
            "{} has no function init(aux)",
        ),
        (
            "c.py",
            format!("\ndef init(): pass\n{callback}"),
            "init() must be init(aux)\n  at {}:2",
        ),
        (
            "d.py",
            "def init(*all): pass\ndef callback(sensor, motor): pass\n".to_owned(),
            "callback(sensor, motor) must be callback(sensor, motor, aux)\n  at {}:2",
        ),
        (
            "async.py",
            "def init(aux): pass\nasync def callback(sensor, motor, aux): pass\n".to_owned(),
            "callback is async, so that a call does nothing; write def without async\n  at {}:2",
        ),
        (
            "generator.py",
            format!("def init(aux): yield\n{callback}"),
            "init holds a yield, so that a call does nothing; write it without\n  at {}:1",
        ),
        (
            "e.txt",
            callback.to_owned(),
            "{} is no Python script: its name does not end in .py",
        ),
        (
            "",
            String::new(),
            "{} is a folder; name the Python file in it",
        ),
    ] {
        let folder = Folder::new(&[]);
        let file = folder.0.join(name);
        if !name.is_empty() {
            fs::write(&file, text).unwrap();
        }
        let session = Session::start(config(file.clone())).unwrap();
        let error = session.init().unwrap_err();
        let message = message.replace("{}", &file.display().to_string());
        assert_eq!((error.to_string(), error.is_fatal()), (message, false));
    }
}

#[test]
fn endless_recursion_names_a_few_places() {
    let (_folder, session) = start(
        "def init(aux): pass\ndef deeper(): deeper()\ndef callback(sensor, motor, aux): deeper()\n",
    );
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest()));
    assert!(error.message.starts_with("RecursionError: "));
    assert_eq!(error.stack.len(), 11);
    assert!(error.to_string().ends_with("robot.py:2\n  at …"), "{error}");
}

#[test]
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

#[test]
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
