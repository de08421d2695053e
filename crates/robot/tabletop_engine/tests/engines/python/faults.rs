//! Faults of scripts are reported with their places.

use std::{fs, time::Duration};

use tabletop_engine::EngineError;
use tabletop_harness::test_with;

use super::{config, of_callback, start};
use crate::common::{self, Folder, Session, script_error};

#[test_with(Python)]
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

#[test_with(Python)]
fn the_cause_of_an_error_is_reported() {
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

#[test_with(Python)]
fn the_errors_of_a_group_are_reported() {
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

#[test_with(Python)]
fn faults_are_reported_with_their_place() {
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
            "motor.gr__e is not a field that the robot knows",
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
            "motor.spin is not a field that the robot knows",
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

#[test_with(Python)]
fn hangs_exits_and_missing_files_are_reported() {
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

#[test_with(Python)]
fn invalid_scripts_are_reported() {
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

#[test_with(Python)]
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
