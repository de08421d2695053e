//! Messages about faults, with remedies.

use std::fs;

use tabletop_engine::{EngineError, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, octave, script_error};

fn message(init: &str, callback: &str) -> String {
    let folder = Folder::pair(init, callback);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let result = session
        .init()
        .and_then(|_| session.step(&common::at_rest()));
    result.unwrap_err().to_string()
}

#[test_with(Octave)]
fn optional_sensor_fields_are_explained() {
    for (callback, hint) in [
        (
            "x = sensor.rgbVision;",
            "structure has no member 'rgbVision': sensor.rgbVision exists only when there is a new picture",
        ),
        ("sensor.rgbVision(1, 2, 3)", "--picture-every 1"),
        ("x = sensor.trackerLoc('l-S1');", "contains this word"),
        ("x = sensor.objects.id;", "--no-objects"),
        ("x = sensor.jointTorques;", "--dynamic"),
    ] {
        let message = message("", callback);
        assert!(
            message.contains(hint) && message.contains("testCallback.m:1"),
            "{message}"
        );
    }
    assert!(message("x = sensor.jointAngles;", "").contains("sensor is empty in the init script"));
    assert!(!message("", "x = sensor.nosuch;").contains("exists only"));
}

#[test_with(Octave)]
fn long_messages_are_cut() {
    for length in [5000, 200_000, 400_000] {
        let message = message("", &format!("error(repmat('x', 1, {length}));"));
        assert!(
            message.starts_with("xxx") && message.len() < 5000,
            "{}",
            message.len()
        );
        assert!(message.contains('…') && message.contains("testCallback.m:1"));
    }
}

#[test_with(Octave)]
fn the_limits_of_sizes_are_named() {
    let folder = Folder::pair("aux.drawMarkers = ones(40000, 3);", "");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    assert_eq!(session.init().unwrap().draw_markers.len(), 40_000);
    let message = message("aux.drawMarkers = ones(200000, 3);", "");
    assert!(
        message.starts_with(
            "aux.drawMarkers is 200000x3 double; it must be Nx3 double, N at most 100000"
        ),
        "{message}"
    );
}

#[test_with(Octave)]
fn a_list_of_motors_is_no_motor() {
    let message = message("", "motor(2).jointVelocities = 1;");
    assert!(
        message.starts_with("motor is 1x2 struct; it must be a struct of size 1x1"),
        "{message}"
    );
}

#[test_with(Octave)]
fn an_invalid_motor_is_reported_with_its_script() {
    let callback = "if true, motor.headVelocity = [1 2]; break, end";
    let folder = Folder::pair("", callback);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let message = session.step(&common::at_rest()).unwrap_err().to_string();
    let script = folder.0.join("testCallback.m");
    assert!(
        message.ends_with(&format!("must be 1x1\n  at {}", script.display())),
        "{message}"
    );
}

#[test_with(Octave)]
fn a_line_that_is_not_known_is_not_made_up() {
    let folder = Folder::pair("", "recurse");
    fs::write(
        folder.0.join("recurse.m"),
        "function recurse()\nrecurse();\nend\n",
    )
    .unwrap();
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest())).to_string();
    assert!(!error.contains(":0"), "{error}");
}

#[cfg(unix)]
#[test_with(Octave)]
fn a_killed_engine_leaves_nothing_behind() {
    for trigger in TRIGGERS {
        for signal in [1, 15] {
            let folder = Folder::pair("", &format!("x = 1; kill(getpid(), {signal}); pause(5);"));
            let current = Folder::new(&[]);
            let mut config = octave(&folder.0, trigger);
            config.working_dir.clone_from(&current.0);
            let session = Session::start(config).unwrap();
            session.init().unwrap();
            let error = session.step(&common::at_rest()).unwrap_err();
            assert!(matches!(error, EngineError::Died { .. }), "{error}");
            assert_eq!(fs::read_dir(&current.0).unwrap().count(), 0);
        }
    }
}

#[test_with(Octave)]
fn an_error_without_a_place_is_in_the_script_that_ran() {
    let errors = [
        ("str2func(3)", "FCN_NAME"),
        (
            "rethrow(struct('message', '', 'identifier', 'a:b'))",
            "error without a message",
        ),
    ];
    for (fault, reported) in errors {
        let folder = Folder::pair("", fault);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        session.init().unwrap();
        let error = script_error(session.step(&common::at_rest())).to_string();
        let place = format!("\n  at {}", folder.0.join("testCallback.m").display());
        assert!(
            error.contains(reported) && error.ends_with(&place),
            "{error}"
        );
        fs::write(folder.0.join("testInit.m"), fault).unwrap();
        let error = script_error(session.init()).to_string();
        let place = format!("\n  at {}", folder.0.join("testInit.m").display());
        assert!(error.ends_with(&place), "{error}");
        let behavior = format!("function [i, c] = agentBehavior()\n{fault}\nend");
        fs::write(folder.0.join("agentBehavior.m"), behavior).unwrap();
        let error = script_error(session.init()).to_string();
        assert!(error.contains("agentBehavior.m"), "{error}");
    }
}

#[test_with(Octave)]
fn variables_cleared_or_overwritten_by_a_callback_are_reported() {
    let cleared = message("", "clear all\ndisp(sensor.timeElapsed)");
    assert!(cleared.contains("comes back in the next call"), "{cleared}");
    let spoilt = message("", "aux = 3;");
    assert!(
        spoilt.starts_with("aux is 1x1 double; it must be a struct"),
        "{spoilt}"
    );
}

#[test_with(Octave)]
fn functions_of_their_own_variables_are_noted() {
    for (callback, is_noted) in [
        (
            "function testCallback\nglobal count\nmotor.headVelocity = 1;",
            true,
        ),
        (
            "function testCallback\nmotor.headVelocity = global_count;",
            true,
        ),
        (
            "function testCallback\n  global motor\nmotor.headVelocity = 1;",
            false,
        ),
        ("function testCallback\nassignin('base', 'x', 1);", false),
        ("global_count = 1;", false),
    ] {
        let folder = Folder::pair("", callback);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        session.init().unwrap();
        let notes = session.engine.drain_console();
        let noted = notes
            .iter()
            .any(|line| line.text.contains("its own variables"));
        assert_eq!(noted, is_noted, "{callback}");
    }
}

#[test_with(Octave)]
fn errors_name_the_remedy() {
    for (init, reported) in [
        (
            "function testInit, disp(aux.path)",
            "global sensor motor aux",
        ),
        ("exit", "aux.exit = true"),
    ] {
        let folder = Folder::pair(init, "");
        let session = Session::octave(&folder.0, Trigger::Stdin);
        let error = session.init().unwrap_err().to_string();
        assert!(error.contains(reported), "{error}");
    }
    let folder = Folder::pair("x = 1;", "");
    let forgotten = "function [i, c] = agentBehavior()\ni = testInit;\nc = @testCallback;\nend";
    fs::write(folder.0.join("agentBehavior.m"), forgotten).unwrap();
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let error = script_error(session.init()).to_string();
    assert!(error.contains("write an @"), "{error}");
}
