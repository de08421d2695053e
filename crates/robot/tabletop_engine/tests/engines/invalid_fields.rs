//! Scripts that misuse their variables: they run on, or the fault is reported.

use std::fs;

use tabletop_engine::{Sensor, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS};

#[test_with(Octave)]
fn a_script_runs_on_after_clearing_anything() {
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
                let motor = session.step(&common::at_rest()).unwrap().motor;
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
                    ..common::at_rest()
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
                    .step(&common::at_rest())
                    .unwrap()
                    .motor
                    .joint_velocities,
                [[0.0; 7]; 2]
            );
        }
    }
}

#[test_with(Octave)]
fn a_callback_may_be_changed_on_the_way() {
    let folder = Folder::pair("", "motor.headVelocity = 1; callbackFunc = @second;");
    fs::write(folder.0.join("second.m"), "motor.headVelocity = 2;").unwrap();
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let head = || {
        session
            .step(&common::at_rest())
            .unwrap()
            .motor
            .head_velocity
    };
    assert_eq!([head(), head(), head()], [Some(1.0), Some(2.0), Some(2.0)]);
}

#[test_with(Octave)]
fn an_invalid_motor_is_reported() {
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
            "motor.jointVelocity is not a field that the robot knows",
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
            let error = session.step(&common::at_rest()).unwrap_err();
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
                .step(&common::at_rest())
                .unwrap()
                .motor
                .gripper_velocities,
            [1.0, 2.0]
        );
    }
}

#[test_with(Octave)]
fn a_misused_aux_is_reported() {
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
        let place = folder.0.join("testInit.m");
        assert_eq!(
            session.init().unwrap_err().to_string(),
            format!("{message}\n  at {}", place.display())
        );
    }
}

#[test_with(Octave)]
fn exit_is_reported_with_any_value() {
    for exit in ["aux.exit = false;", "aux.exit = [];", "aux.exit = 'now';"] {
        let folder = Folder::pair("", exit);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        assert!(!session.init().unwrap().exit);
        assert!(session.step(&common::at_rest()).unwrap().exit);
        let folder = Folder::pair(exit, "");
        let session = Session::octave(&folder.0, Trigger::Stdin);
        assert!(session.init().unwrap().exit);
        assert!(session.step(&common::at_rest()).unwrap().exit);
    }
}

#[test_with(Octave)]
fn a_callback_that_is_overwritten_is_reported() {
    let folder = Folder::pair("", "callbackFunc = 5;");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let error = session.step(&common::at_rest()).unwrap_err().to_string();
    assert!(error.starts_with("callbackFunc is 1x1 double"), "{error}");
}

#[test_with(Octave)]
fn complex_numbers_that_are_real_are_taken() {
    let folder = Folder::pair("", "motor.jointVelocities = complex(ones(2, 7), 0);");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.joint_velocities, [[1.0; 7]; 2]);
}
