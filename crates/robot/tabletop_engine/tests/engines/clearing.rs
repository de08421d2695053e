//! Scripts that clear variables or functions of the driver.

use std::path;

use tabletop_engine::{MotorCommand, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS};

fn motors(init: &str, callback: &str, trigger: Trigger) -> [MotorCommand; 2] {
    let folder = Folder::pair(init, callback);
    std::fs::write(folder.0.join("helper.m"), "motor.headVelocity = 2;").unwrap();
    let session = Session::octave(&folder.0, trigger);
    session.init().unwrap();
    [(); 2].map(|()| {
        let result = session.step(&common::at_rest());
        result
            .unwrap_or_else(|error| panic!("{init} {callback}: {error}"))
            .motor
    })
}

#[test_with(Octave)]
fn the_script_runs_on_after_any_change_of_the_path() {
    for trigger in TRIGGERS {
        for change in [
            "restoredefaultpath;",
            "path('');",
            "for p = strsplit(path, pathsep), if any(strfind(p{1}, 'driver')), rmpath(p{1}); end, end;",
        ] {
            let [_, motor] = motors(change, "helper; pause(0);", trigger);
            assert_eq!(motor.head_velocity, Some(2.0));
            let callback = format!("motor.headVelocity = 3; {change}");
            let [_, motor] = motors("", &callback, trigger);
            assert_eq!(motor.head_velocity, Some(3.0));
            let folder = Folder::pair("", &format!("{change} error('mine');"));
            let session = Session::octave(&folder.0, trigger);
            for _ in 0..2 {
                session.init().unwrap();
                let error = common::script_error(session.step(&common::at_rest()));
                assert_eq!(error.message, "mine");
            }
        }
    }
}

#[test_with(Octave)]
fn a_motor_that_was_cleared_is_at_rest() {
    for trigger in TRIGGERS {
        for clear in [
            "clear all;",
            "clear global;",
            "clear motor;",
            "clear;",
            "clear -all; close all; clc;",
        ] {
            let callback = format!(
                "{clear} motor.jointVelocities(2, 1) = 0.5; motor.gripperVelocities(1) = 1;"
            );
            let mut expected = MotorCommand {
                gripper_velocities: vec![1.0, 0.0],
                ..MotorCommand::at_rest([2, 7])
            };
            expected.joint_velocities[1][0] = 0.5;
            assert_eq!(
                motors("", &callback, trigger),
                [expected.clone(), expected],
                "{clear}"
            );
        }
    }
}

#[test_with(Octave)]
fn cleared_globals_may_be_declared_again() {
    for trigger in TRIGGERS {
        for declare in ["sensor motor aux", "motor", "aux"] {
            let heading = format!("clear all; close all; clc; global {declare};");
            let callback = "motor.headVelocity = 2;";
            let [_, motor] = motors(&heading, callback, trigger);
            assert_eq!(motor.head_velocity, Some(2.0));
            let [_, motor] = motors("", &heading, trigger);
            assert_eq!(motor, MotorCommand::at_rest([2, 7]));
            let [_, motor] = motors("", &format!("{heading} {callback}"), trigger);
            assert_eq!(motor.head_velocity, Some(2.0), "{declare}");
        }
    }
}

#[test_with(Octave)]
fn variables_may_have_any_name() {
    for name in [
        "exist",
        "isglobal",
        "evalin",
        "isfield",
        "tabletop_relink",
        "path",
        "sensor_",
        "clear",
    ] {
        let callback = "motor = struct('headVelocity', 2);";
        let [_, motor] = motors(&format!("{name} = 1;"), callback, Trigger::Stdin);
        assert_eq!(motor.head_velocity, Some(2.0), "{name}");
    }
    let init = "exist = 1; isglobal = 2;";
    let [_, motor] = motors(
        init,
        "clear motor; motor.headVelocity = exist + isglobal;",
        Trigger::Stdin,
    );
    assert_eq!(motor.head_velocity, Some(3.0));
}

#[test_with(Octave)]
fn another_copy_of_the_driver_does_no_harm() {
    let repository = path::absolute("matlab").unwrap();
    let add = format!("clear all; addpath(genpath('{}'));", repository.display());
    for trigger in TRIGGERS {
        let [_, motor] = motors(&add, "clear all; motor.headVelocity = 3;", trigger);
        assert_eq!(motor.head_velocity, Some(3.0));
        let [_, motor] = motors("", &format!("{add} motor.headVelocity = 3;"), trigger);
        assert_eq!(motor.head_velocity, Some(3.0));
    }
}

#[cfg(unix)]
#[test_with(Octave)]
fn the_path_is_not_saved() {
    let home = Folder::new(&[]);
    let folder = Folder::pair(
        &format!(
            "setenv('HOME', '{}'); savepath; savepath; disp ready",
            home.0.display()
        ),
        "",
    );
    for trigger in TRIGGERS {
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("ready");
        assert_eq!(printed.matches("no effect").count(), 1, "{printed}");
        assert_eq!(std::fs::read_dir(&home.0).unwrap().count(), 0);
    }
}

#[test_with(Octave)]
fn the_last_answer_is_kept() {
    for trigger in TRIGGERS {
        let [first, second] = motors("3 + 4;", "motor.headVelocity = ans; ans + 1;", trigger);
        assert_eq!(first.head_velocity, Some(7.0));
        assert_eq!(second.head_velocity, Some(8.0));
    }
}
