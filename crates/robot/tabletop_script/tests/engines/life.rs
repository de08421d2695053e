//! The life of a script: start, a call a tick, and an end that leaves nothing behind.

use std::{f64::consts::FRAC_PI_2, path};

use tabletop_core::{
    Agent, Arm, ClockCommand, Robot, RobotJoint, ScriptCommand, ScriptEvent, TICK_SECONDS,
};
use tabletop_harness::test_with;

use crate::kit::{Folder, Stage, octave};

const TICK: f64 = TICK_SECONDS as f64;
const INIT: &str = "aux.drawMarkers = [1 2 3; 4 5 6];\ncalls = 0;\n";
const MOVING: &str =
    "calls = calls + 1;\nmotor.jointVelocities(:) = 0.25;\nmotor.gripperVelocities = [-0.5; -1];\n";

fn angles(robot: &Robot) -> [[f64; 7]; 2] {
    Arm::BOTH.map(|arm| robot.angles(arm))
}

#[test_with(Octave)]
fn the_example_turns_every_joint_as_long_as_its_limits_allow() {
    let scripts = path::absolute("../../../matlab").unwrap();
    let mut stage = Stage::start(octave(&scripts));
    stage.ticks(1);
    assert!(stage.is_online());
    assert_eq!(stage.markers(), 4);
    stage.ticks(300);
    for (arm, angles) in Arm::BOTH.into_iter().zip(angles(stage.robot())) {
        for (joint, angle) in RobotJoint::of_arm(arm).into_iter().zip(angles) {
            let mut expected = if joint == RobotJoint::RightE0 {
                FRAC_PI_2
            } else {
                0.0
            };
            for _ in 0..300 {
                expected = joint.clamp(expected + 0.5 * TICK);
            }
            assert_eq!(angle, expected, "{joint}");
        }
        assert_eq!(stage.robot().joint(RobotJoint::gripper(arm)).position, 0.0);
    }
    // Then all turns back, as far as it can.
    stage.ticks(30);
    let back = stage.robot().joint(RobotJoint::LeftS0).position;
    assert!((back - (1.7 - 30.0 * 0.5 * TICK)).abs() < 1e-12, "{back}");
}

#[test_with(Octave)]
fn functions_that_declare_globals_act_like_scripts() {
    let init = "aux.initJointAngles = repmat([0.1 0.2 0.3 1.4 0.5 0.6 0.7], 2, 1);\nphase = 0;\n";
    let callback = "phase = phase + sensor.timeElapsed;
motor.jointVelocities = (0.5 + sensor.jointAngles / 10) * cos(3 * phase);
motor.gripperVelocities = sin(phase) * [1; -1] + sensor.endEffPos(:, 3) / 100;
motor.headVelocity = phase / 20;
if phase > 2, aux.exit = 1; end
";
    let globals = |name: &str, body: &str| {
        format!("function {name}\nglobal sensor motor aux phase\n{body}end\n")
    };
    let run = |folder: Folder| {
        let mut stage = Stage::start(folder.settings());
        stage.ticks_until(Stage::has_stopped);
        stage.track().to_vec()
    };
    let scripts = run(Folder::pair(init, callback));
    let functions = run(Folder::pair(
        &globals("testInit", init),
        &globals("testCallback", callback),
    ));
    assert_eq!(scripts.len(), 120);
    assert_eq!(scripts, functions);
    assert_ne!(scripts[5], scripts[100]);
}

#[test_with(Octave)]
fn a_script_that_exits_leaves_nothing_behind() {
    let folder = Folder::pair(
        INIT,
        &format!("{MOVING}if calls == 10, aux.exit = false; end\n"),
    );
    let mut stage = Stage::start(folder.settings());
    stage.ticks_until(Stage::has_stopped);
    assert_eq!(stage.agent(), &Agent::Off);
    // The tenth call is the last, and its velocities are for no tick.
    let moved = stage.robot().joint(RobotJoint::LeftW2).position;
    assert!((moved - 9.0 * 0.25 * TICK).abs() < 1e-12, "{moved}");
    stage.assert_at_rest();
}

#[test_with(Octave)]
fn exit_in_init_ends_the_script_before_any_callback() {
    let folder = Folder::pair(
        "aux.exit = 1; aux.initJointAngles = zeros(2, 7); aux.drawMarkers = [1 2 3];",
        "disp('called');",
    );
    let mut stage = Stage::start(folder.settings());
    stage.ticks_until(Stage::has_stopped);
    assert_eq!(stage.agent(), &Agent::Off);
    assert_eq!(stage.printed(), "");
    stage.assert_at_rest();
    assert_eq!(angles(stage.robot()), [[0.0; 7]; 2]);
}

/// Table 1 of the report, in the order S0, S1, E0, E1, W0, W1, W2: least and greatest angle in rad.
const TABLE_1: [[f64; 7]; 2] = [
    [-1.7, -2.147, -3.054, -0.050, -3.059, -FRAC_PI_2, -3.059],
    [1.7, 1.047, 3.054, 2.618, 3.059, 2.094, 3.059],
];

#[test_with(Octave)]
fn a_script_reads_table_1_of_the_report_and_the_openings_of_the_grippers() {
    let matrix = |row: [f64; 7]| {
        format!(
            "repmat([{}], 2, 1)",
            row.map(|x| format!("{x:?}")).join(" ")
        )
    };
    let [least, greatest] = TABLE_1.map(matrix);
    let init = format!(
        "assert(isequal(aux.minJointAngles, {least}));
assert(isequal(aux.maxJointAngles, {greatest}));
assert(isequal(aux.numLimbs, 2) && isequal(aux.numJoints, 7));
assert(ischar(aux.path) && aux.path(end) == '/' && exist([aux.path 'testInit.m'], 'file') == 2);
openings = [];
"
    );
    let callback = "openings(end + 1, :) = sensor.gripperOpening;
motor.gripperVelocities = [-60; -30];
if rows(openings) == 3
  assert(isequal(size(sensor.gripperOpening), [1 2]));
  assert(abs(openings - [2 2; 1 1.5; 0 1]) < 1e-6);
  aux.exit = 1;
end
";
    let folder = Folder::pair(&init, callback);
    let mut stage = Stage::start(folder.settings());
    stage.ticks_until(|stage| stage.has_stopped() || stage.failure().is_some());
    assert_eq!(stage.failure(), None);
}

#[test_with(Octave)]
fn a_script_that_is_stopped_leaves_nothing_behind_and_starts_afresh() {
    let folder = Folder::pair(INIT, MOVING);
    let mut stage = Stage::start(folder.settings());
    for _ in 0..2 {
        stage.ticks_until(Stage::is_online);
        let before = angles(stage.robot());
        stage.ticks(30);
        assert_eq!(stage.markers(), 2);
        assert_ne!(angles(stage.robot()), before, "a hidden robot moves, too");
        stage.script(ScriptCommand::Stop);
        stage.ticks(1);
        assert!(stage.has_stopped());
        assert_eq!(stage.agent(), &Agent::Off);
        stage.assert_at_rest();
        stage.script(ScriptCommand::Start);
    }
}

#[test_with(Octave)]
fn a_second_start_and_a_stop_of_nothing_do_nothing() {
    let folder = Folder::pair("disp('init'); calls = 0;", MOVING);
    let mut stage = Stage::start(folder.settings());
    stage.script(ScriptCommand::Start);
    stage.ticks(3);
    stage.script(ScriptCommand::Start);
    stage.ticks(3);
    assert_eq!(stage.printed(), "init");
    stage.script(ScriptCommand::Stop);
    stage.script(ScriptCommand::Stop);
    stage.ticks(1);
    stage.script(ScriptCommand::Stop);
    stage.ticks(1);
    let ends = stage
        .events
        .iter()
        .filter(|event| **event == ScriptEvent::Stopped);
    assert_eq!(ends.count(), 1);
}

#[test_with(Octave)]
fn while_paused_there_are_no_calls() {
    let folder = Folder::pair(
        INIT,
        &format!(
            "{MOVING}elapsed(calls) = sensor.timeElapsed;\nfresh(calls) = isfield(sensor, 'rgbVision');\nif calls == 20, disp([max(elapsed) * 60, find(fresh)]); end\n"
        ),
    );
    let mut stage = Stage::start(folder.settings());
    stage.ticks(15);
    // The pause comes in the tick whose picture the script is to get.
    stage.command(ClockCommand::SetPaused(true));
    stage.ticks(5);
    let before = angles(stage.robot());
    stage.ticks(20);
    assert_eq!(angles(stage.robot()), before);
    assert_eq!(stage.markers(), 2);
    stage.command(ClockCommand::SetPaused(false));
    stage.ticks(10);
    let printed = stage.printed();
    let numbers: Vec<f64> = printed
        .split_whitespace()
        .map(|word| word.parse().unwrap())
        .collect();
    assert!(
        (numbers[0] - 1.0).abs() < 1e-4,
        "a pause is no time: {printed}"
    );
    assert_eq!(numbers[1..], [1.0, 16.0], "{printed}");
}

#[test_with(Octave)]
fn a_script_that_is_started_in_a_pause_begins_after_it() {
    let folder = Folder::pair("aux.initJointAngles = 0.25 * ones(2, 7);", "");
    let mut stage = Stage::start(folder.settings());
    stage.command(ClockCommand::SetPaused(true));
    stage.ticks(3);
    assert_eq!(stage.agent(), &Agent::Starting);
    stage.command(ClockCommand::SetPaused(false));
    stage.ticks(1);
    assert_eq!(stage.robot().joint(RobotJoint::LeftS0).position, 0.25);
}
