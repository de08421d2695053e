//! Scripts that fail, hang, crash or do what they should not: each is told exactly, and only the agent stops.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::{
    fs,
    time::{Duration, Instant},
};

use common::{Folder, Session, TRIGGERS, octave, script_error};
use tabletop_engine::{EngineError, EngineHandle, Reply, Sensor, Stream, Trigger};

/// Runs a pair until it has failed in the callback.
fn callback_fault(init: &str, callback: &str, trigger: Trigger) -> EngineError {
    let folder = Folder::pair(init, callback);
    let session = Session::octave(&folder.0, trigger);
    session.init().unwrap();
    session.step(&Sensor::default()).unwrap_err()
}

#[test]
fn an_error_is_told_with_its_place() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("x = 1;", "y = x;\nhelper(y);\n");
        fs::write(
            folder.0.join("helper.m"),
            "function helper(y)\nundefined_thing(y);\nend\n",
        )
        .unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&Sensor::default()));
        assert_eq!(error.id, "Octave:undefined-function");
        assert!(
            error.message.contains("'undefined_thing' undefined"),
            "{error}"
        );
        let places: Vec<_> = error
            .stack
            .iter()
            .map(|place| (place.file.clone(), place.line))
            .collect();
        assert_eq!(
            places,
            [
                (folder.0.join("helper.m"), 2),
                (folder.0.join("testCallback.m"), 2)
            ],
            "{error}"
        );
        // The engine lives on and starts afresh.
        fs::write(folder.0.join("helper.m"), "function helper(y)\nend\n").unwrap();
        session.init().unwrap();
    }
}

#[test]
fn errors_of_all_kinds_are_told() {
    let faults = [
        ("error('my:id', 'no %d', 3)", "my:id", "no 3"),
        (
            "[1 2 3] * [4 5 6]",
            "Octave:nonconformant-args",
            "operator *",
        ),
        (
            "x = zeros(1e6, 1e6, 'double') + 1;",
            "Octave:",
            "out of memory",
        ),
        (
            "answer = input('what? ');",
            "tabletop:input",
            "nobody can answer",
        ),
        ("keyboard", "tabletop:input", "nobody can type"),
        ("a = {}; a{3}", "Octave:index-out-of-bounds", "out of bound"),
    ];
    let folder = Folder::pair("", "");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    for (script, id, message) in faults {
        fs::write(
            folder.0.join("testCallback.m"),
            format!("% line 1\n{script}\n"),
        )
        .unwrap();
        session.init().unwrap();
        let error = script_error(session.step(&Sensor::default()));
        assert!(
            error.id.starts_with(id) && error.message.contains(message),
            "{script}: {} {error}",
            error.id
        );
        assert_eq!(
            error.place().unwrap().to_string(),
            format!("{}:2", folder.0.join("testCallback.m").display())
        );
    }
}

#[test]
fn endless_recursion_is_an_error() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("", "deeper(1);");
        fs::write(
            folder.0.join("deeper.m"),
            "function deeper(n)\ndeeper(n + 1);\nend\n",
        )
        .unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&Sensor::default()));
        assert!(error.message.contains("max_recursion_depth"), "{error}");
    }
}

#[test]
fn wrong_syntax_is_told_with_its_place() {
    for script in ["x = 1;\nif x\n  y = = 3;\nend\n", "x = 1;\nbreak\ny = ;\n"] {
        let folder = Folder::pair("", script);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        let error = script_error(
            session
                .init()
                .and_then(|_| session.step(&Sensor::default())),
        );
        assert!(error.message.contains("parse error"), "{error}");
        let place = error.place().unwrap();
        assert_eq!(place.file, folder.0.join("testCallback.m"));
        assert!(place.line >= 2, "{error}");
    }
}

#[test]
fn what_is_missing_is_told() {
    let folder = Folder::new(&[(
        "agentBehavior.m",
        "function [i, c] = agentBehavior()\ni = @nosuch;\nc = @nosuch;\nend\n",
    )]);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let error = script_error(session.init());
    assert!(error.message.contains("nosuch"), "{error}");
    let folder = Folder::new(&[]);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let error = script_error(session.init());
    assert!(error.message.contains("agentBehavior"), "{error}");
}

#[test]
fn whatever_a_script_clears_it_runs_on() {
    let inits = [
        "clear all; close all; clc; count = 0;",
        "fclose('all'); count = 0;",
        "clear; count = 0; aux.mine = 1;",
    ];
    for trigger in TRIGGERS {
        for init in inits {
            let folder = Folder::pair(
                init,
                "count = count + 1; motor.headVelocity = count + aux.numLimbs;",
            );
            let session = Session::octave(&folder.0, trigger);
            session.init().unwrap();
            for count in 1..3 {
                let motor = session.step(&Sensor::default()).unwrap().motor;
                assert_eq!(motor.head_velocity, Some(f64::from(count + 2)), "{init}");
            }
        }
        let callbacks = [
            "motor.headVelocity = sensor.timeElapsed; clear",
            "clear; motor.headVelocity = 2; motor.jointVelocities = zeros(2, 7);",
            "fclose('all'); motor.headVelocity = 2;",
            "clear functions; motor.headVelocity = 2;",
            "clear motor callbackFunc; motor.headVelocity = 2;",
            "clear -all; clear classes; close all; clc; motor.headVelocity = 2; motor.gripperVelocities = zeros(2, 1);",
        ];
        for callback in callbacks {
            let folder = Folder::pair("", callback);
            let session = Session::octave(&folder.0, trigger);
            session.init().unwrap();
            for _ in 0..3 {
                let sensor = Sensor {
                    time_elapsed: 2.0,
                    ..Sensor::default()
                };
                let motor = session.step(&sensor).unwrap().motor;
                assert_eq!(motor.head_velocity, Some(2.0), "{callback}");
            }
        }
        let folder = Folder::pair("", "clear all");
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        for _ in 0..3 {
            assert_eq!(
                session
                    .step(&Sensor::default())
                    .unwrap()
                    .motor
                    .joint_velocities,
                [[0.0; 7]; 2]
            );
        }
    }
}

#[test]
fn a_callback_may_be_changed_on_the_way() {
    let folder = Folder::pair("", "motor.headVelocity = 1; callbackFunc = @second;");
    fs::write(folder.0.join("second.m"), "motor.headVelocity = 2;").unwrap();
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let head = || {
        session
            .step(&Sensor::default())
            .unwrap()
            .motor
            .head_velocity
    };
    assert_eq!([head(), head(), head()], [Some(1.0), Some(2.0), Some(2.0)]);
}

#[test]
fn a_misused_motor_is_told() {
    let faults = [
        (
            "motor.jointVelocities = zeros(3, 7);",
            "motor.jointVelocities is 3x7 double; it must be 2x7",
        ),
        (
            "motor.gripperVelocities = [1 2];",
            "motor.gripperVelocities is 1x2 double; it must be 2x1",
        ),
        (
            "motor.jointVelocities = 'fast';",
            "motor.jointVelocities is 1x4 char; it must be 2x7 double",
        ),
        (
            "motor.jointAngles = cell(2, 7);",
            "motor.jointAngles is 2x7 cell; it must be 2x7 double",
        ),
        (
            "motor.jointVelocities = i * ones(2, 7);",
            "motor.jointVelocities is 2x7 complex; it must be 2x7 double",
        ),
        (
            "motor.jointVelocities = true(2, 7);",
            "motor.jointVelocities is 2x7 logical; it must be 2x7 double",
        ),
        (
            "motor.jointVelocities(2, 3) = NaN;",
            "motor.jointVelocities(2,3) is NaN; it must be a finite number",
        ),
        (
            "motor.jointAngles = [];",
            "motor.jointAngles is 0x0 double; it must be 2x7",
        ),
        (
            "motor.headVelocity = Inf;",
            "motor.headVelocity(1,1) is Inf; it must be a finite number",
        ),
        (
            "motor.jointAngles = zeros(9000);",
            "motor.jointAngles is 9000x9000 double; it must be 2x7 double",
        ),
        ("motor = 3;", "motor is 1x1 double; it must be a struct"),
        (
            "motor(2).jointVelocities = 3;",
            "motor is 1x2 struct; it must be a struct",
        ),
        (
            "motor.jointVelocity = 1;",
            "motor.jointVelocity is no field that the robot knows",
        ),
        (
            "motor.headVelocity = ones(2, 2, 2, 2, 2, 2, 2, 2, 2, 2);",
            "motor.headVelocity is 2x2x2x2x2x2x2x8 double",
        ),
    ];
    for trigger in TRIGGERS {
        let folder = Folder::pair("", "");
        let session = Session::octave(&folder.0, trigger);
        for (script, message) in faults {
            fs::write(folder.0.join("testCallback.m"), script).unwrap();
            session.init().unwrap();
            let error = session.step(&Sensor::default()).unwrap_err();
            assert!(
                !error.is_fatal() && error.to_string().starts_with(message),
                "{script}: {error}"
            );
        }
        let good =
            "motor.jointVelocities = sparse(ones(2, 7)); motor.gripperVelocities = int8([1; 2]);";
        fs::write(folder.0.join("testCallback.m"), good).unwrap();
        session.init().unwrap();
        assert_eq!(
            session
                .step(&Sensor::default())
                .unwrap()
                .motor
                .gripper_velocities,
            [1.0, 2.0]
        );
    }
}

#[test]
fn a_misused_aux_is_told() {
    for (script, message) in [
        (
            "aux.drawMarkers = [1 2];",
            "aux.drawMarkers is 1x2 double; it must be Nx3",
        ),
        (
            "aux.initJointAngles = zeros(7, 2);",
            "aux.initJointAngles is 7x2 double; it must be 2x7",
        ),
        ("aux = 3;", "aux is 1x1 double; it must be a struct"),
    ] {
        let folder = Folder::pair(script, "");
        let session = Session::octave(&folder.0, Trigger::Stdin);
        assert_eq!(session.init().unwrap_err().to_string(), message);
    }
}

#[test]
fn exit_is_told_whatever_its_value() {
    for exit in ["aux.exit = false;", "aux.exit = [];", "aux.exit = 'now';"] {
        let folder = Folder::pair("", exit);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        assert!(!session.init().unwrap().exit);
        assert!(session.step(&Sensor::default()).unwrap().exit);
        let folder = Folder::pair(exit, "");
        let session = Session::octave(&folder.0, Trigger::Stdin);
        assert!(session.init().unwrap().exit);
        assert!(session.step(&Sensor::default()).unwrap().exit);
    }
}

#[test]
fn an_endless_loop_ends_in_time() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("", "while true, end");
        let mut config = octave(&folder.0, trigger);
        config.timeouts.step = Duration::from_millis(300);
        let session = Session::start(config).unwrap();
        session.init().unwrap();
        let start = Instant::now();
        let error = session.step(&Sensor::default()).unwrap_err();
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
        assert!((Duration::from_millis(300)..Duration::from_secs(5)).contains(&start.elapsed()));
        assert!(
            session
                .engine
                .recv_timeout(Duration::from_secs(5))
                .is_none(),
            "nothing comes after the end"
        );
    }
}

#[test]
fn a_running_script_can_be_stopped_from_any_thread() {
    for trigger in TRIGGERS {
        for kill in [EngineHandle::stop, EngineHandle::kill] {
            let folder = Folder::pair("", "while true, end");
            let session = Session::octave(&folder.0, trigger);
            session.init().unwrap();
            session.engine.step(Sensor::default());
            assert!(
                session
                    .engine
                    .recv_timeout(Duration::from_millis(100))
                    .is_none(),
                "the caller does not wait"
            );
            let other = session.engine.clone();
            std::thread::spawn(move || kill(&other)).join().unwrap();
            let start = Instant::now();
            let reply = session.engine.recv_timeout(Duration::from_secs(10));
            assert!(
                matches!(reply, Some(Reply::Failed(EngineError::Stopped))),
                "{reply:?}"
            );
            assert!(start.elapsed() < Duration::from_secs(3));
        }
    }
}

#[test]
fn an_engine_can_be_killed_before_it_has_started() {
    let folder = Folder::pair("", "");
    let engine = EngineHandle::start(octave(&folder.0, Trigger::Stdin)).unwrap();
    engine.kill();
    let reply = engine.recv_timeout(Duration::from_secs(10));
    assert!(
        matches!(reply, Some(Reply::Failed(EngineError::Stopped))),
        "{reply:?}"
    );
}

#[test]
fn a_crash_is_told_from_an_error() {
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

#[test]
fn an_idle_engine_that_ends_is_noticed() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "pid = getpid(); system(sprintf('(sleep 0.3; kill -9 %d) >/dev/null 2>&1 &', pid));",
            "",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let reply = session.engine.recv_timeout(Duration::from_secs(20));
        assert!(
            matches!(reply, Some(Reply::Failed(EngineError::Died { .. }))),
            "{reply:?}"
        );
    }
}

#[test]
fn what_scripts_print_arrives_apart_from_replies() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "disp('from init'); x = 3",
            "printf('no end of line'); fprintf(stderr, 'a warning\\n'); sensor\nfprintf('%s\\n', char(1)); fprintf('done');",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("x = 3");
        assert!(printed.contains("from init\nx = 3\n"), "{printed}");
        session.step(&Sensor::default()).unwrap();
        let printed = session.printed("timeElapsed");
        assert!(
            printed.contains("no end of line") && printed.contains("timeElapsed: 1x1 scalar"),
            "{printed}"
        );
    }
}

#[test]
fn a_flood_of_output_neither_blocks_nor_piles_up() {
    let folder = Folder::pair("", "for k = 1:200000, printf('line %d\\n', k); end");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    session.step(&Sensor::default()).unwrap();
    session.step(&Sensor::default()).unwrap();
    let lines = session.engine.drain_console();
    assert!(lines.len() < 1100, "{}", lines.len());
    assert!(
        lines
            .iter()
            .any(|line| line.stream == Stream::Note && line.text.contains("left out"))
    );
}

#[test]
fn a_folder_with_an_awkward_name_works() {
    let folder = Folder::new(&[]);
    let awkward = folder.0.join("it's a föl'der");
    fs::create_dir(&awkward).unwrap();
    for (name, text) in [
        (
            "agentBehavior.m",
            "function [i, c] = agentBehavior(), i = @a; c = @b; end",
        ),
        ("a.m", ""),
        ("b.m", "error('ü')"),
    ] {
        fs::write(awkward.join(name), text).unwrap();
    }
    for trigger in TRIGGERS {
        let session = Session::octave(&awkward, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&Sensor::default()));
        assert_eq!(
            (error.message.as_str(), error.place().unwrap().file.clone()),
            ("ü", awkward.join("b.m"))
        );
    }
}

#[test]
fn an_engine_that_cannot_start_says_why() {
    let folder = Folder::pair("", "");
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.working_dir = folder.0.join("nosuch");
    let error = Session::start(config).err().unwrap();
    assert!(error.to_string().contains("no directory"), "{error}");
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.engine.program = "/bin/false".into();
    let error = Session::start(config).err().unwrap();
    assert!(matches!(error, EngineError::Died { .. }), "{error}");
}

#[test]
#[cfg(unix)]
fn an_engine_that_answers_nonsense_is_told() {
    use std::os::unix::fs::PermissionsExt as _;
    let script = "#!/bin/sh\nread -r first\nread -r call\nfolder=$(echo \"$call\" | cut -d \"'\" -f 4)\n\
                  printf 'TTA1\\1\\0\\0\\0\\377\\377\\377\\377' > \"$folder/reply.bin\"\nprintf '\\001done 1\\n'\nsleep 1000\n";
    let folder = Folder::new(&[("octave-cli", script)]);
    let program = folder.0.join("octave-cli");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.engine.program = program;
    let error = Session::start(config).err().unwrap();
    assert!(matches!(error, EngineError::Protocol(_)), "{error}");
}
