//! Scripts that fail, hang or crash: the message names the error and its place, only the agent stops, and it can be started again.

use std::{fs, time::Duration};

use tabletop_core::ScriptCommand;
use tabletop_harness::test_with;

use crate::kit::{Folder, Stage, failure};

const INIT: &str = "aux.drawMarkers = [1 2 3];\ncalls = 0;\n";
/// Three good calls come before the error in line 4.
const GOOD: &str =
    "calls = calls + 1;\nmotor.jointVelocities(:) = 0.2;\nif calls < 4, return; end\n";

/// The failure of a callback with this fourth line.
fn callback_failure(line: &str) -> String {
    let folder = Folder::pair(INIT, &format!("{GOOD}{line}\n"));
    folder.write("helper.m", "function helper(x)\nundefined_thing(x);\nend\n");
    let mut settings = folder.settings();
    if line.starts_with("while") {
        settings.timeouts.step = Duration::from_secs(2);
    }
    failure(settings)
}

#[test_with(Octave)]
fn errors_of_callbacks_are_reported_with_file_and_line() {
    for (line, message, places) in [
        (
            "helper(1)",
            "'undefined_thing' undefined",
            ["helper.m:2", "testCallback.m:4"],
        ),
        (
            "x = nobody_knows;",
            "'nobody_knows' undefined",
            ["testCallback.m:4"; 2],
        ),
        (
            "error('my:id', 'no %d', 7);",
            "no 7",
            ["testCallback.m:4"; 2],
        ),
        ("[1 2 3] * [4 5 6];", "operator *", ["testCallback.m:4"; 2]),
    ] {
        let reason = callback_failure(line);
        assert!(reason.contains(message), "{reason}");
        for place in places {
            assert!(reason.contains(place), "{reason}");
        }
    }
}

#[test_with(Octave)]
fn invalid_motor_values_are_reported() {
    for (line, message) in [
        (
            "motor.jointVelocities = zeros(3, 7);",
            "motor.jointVelocities is 3x7 double; it must be 2x7",
        ),
        (
            "motor.gripperVelocities = [0 0];",
            "motor.gripperVelocities is 1x2 double; it must be 2x1",
        ),
        (
            "motor.jointVelocities(2, 3) = NaN;",
            "motor.jointVelocities(2,3) is NaN; it must be a finite number",
        ),
        (
            "motor.jointAngles = Inf(2, 7);",
            "motor.jointAngles(1,1) is Inf; it must be a finite number",
        ),
        (
            "motor.jointVelocities = 'fast';",
            "motor.jointVelocities is 1x4 char; it must be 2x7 double",
        ),
        (
            "motor.jointVelocity = zeros(2, 7);",
            "did you mean jointVelocities?",
        ),
        ("motor = 3;", "motor is 1x1 double; it must be a struct"),
    ] {
        let reason = callback_failure(line);
        assert!(reason.contains(message), "{line}: {reason}");
    }
}

#[test_with(Octave)]
fn endless_loops_crashes_and_exits_are_distinguished() {
    for (line, message) in [
        (
            "while true, end",
            "no answer from the callback script within 2 s; the engine was ended",
        ),
        ("kill(getpid(), 9);", "the engine ended (signal: 9"),
        ("exit(3);", "the engine ended (exit status: 3)"),
    ] {
        let reason = callback_failure(line);
        assert!(reason.contains(message), "{line}: {reason}");
    }
}

#[test_with(Octave)]
fn faults_before_the_first_call_are_reported() {
    let reason = |folder: &Folder| failure(folder.settings());
    let init = Folder::pair("x = 1;\ny = x + z;\n", GOOD);
    assert!(reason(&init).contains("'z' undefined"), "{}", reason(&init));
    assert!(reason(&init).contains("testInit.m:2"), "{}", reason(&init));

    let syntax = Folder::pair(INIT, "x = 1;\ny = (2;\n");
    assert!(
        reason(&syntax).contains("testCallback.m:2"),
        "{}",
        reason(&syntax)
    );

    let markers = Folder::pair("aux.drawMarkers = [1 2];", GOOD);
    assert!(reason(&markers).contains("aux.drawMarkers is 1x2 double; it must be Nx3"));

    let angles = Folder::pair("aux.initJointAngles = 1:7;", GOOD);
    assert!(reason(&angles).contains("aux.initJointAngles is 1x7 double; it must be 2x7"));

    let nobody = Folder::pair(INIT, GOOD);
    fs::remove_file(nobody.0.join("testCallback.m")).unwrap();
    assert!(
        reason(&nobody).contains("testCallback"),
        "{}",
        reason(&nobody)
    );

    let mut nowhere = nobody.settings();
    nowhere.agent = Some(nobody.0.join("no such folder"));
    assert!(failure(nowhere).contains("there is no "));
}

#[test_with(Octave)]
fn after_an_error_the_mended_script_can_be_started() {
    let folder = Folder::pair(INIT, "nobody_knows;");
    let mut stage = Stage::start(folder.settings());
    stage.ticks_until(|stage| stage.failure().is_some());
    folder.write("testCallback.m", GOOD);
    stage.script(ScriptCommand::Start);
    stage.ticks_until(Stage::is_online);
    stage.ticks(10);
    assert!(stage.is_online());
    assert_eq!(stage.markers(), 1);
}
