//! A robot of one arm, end to end: 1×7 for the Panda where Baxter has 2×7.

use std::fs;

use serde_json::Value;
use tabletop_harness::test_with;

use crate::support::{command, place, stderr};

const ROBOT: [&str; 2] = ["--robot", "assets/panda/robot.ron"];

/// The Panda after a second of a script.
fn after_a_second_of(script: &str, engine: &str) -> Value {
    let run = ["run", "--script", script, "--seconds", "1"];
    let run = [&run[..], &ROBOT, &["--final-robot", "-"]].concat();
    let mut run = command(&run);
    let output = run.env("TABLETOP_ENGINE", engine).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    robot["panda"].clone()
}

fn angle(robot: &Value, joint: usize) -> f64 {
    robot["angles"][joint].as_f64().unwrap()
}

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-5, "{value}, not {expected}");
}

#[test_with(Python)]
fn the_example_of_any_robot_waves_with_the_panda() {
    let robot = after_a_second_of("python:python/wave.py", "auto");
    assert_eq!(robot["angles"].as_array().unwrap().len(), 7);
    // It starts in the middle of every joint's range.
    assert_near(angle(&robot, 3), (-3.0718 - 0.0698) / 2.0);
    assert_near(angle(&robot, 6), 0.5);
    assert_near(robot["gripper_opening"].as_f64().unwrap(), 0.8 - 0.3);
}

#[test_with(Octave)]
fn octave_moves_the_panda_by_one_row() {
    let folder = place("panda-octave");
    fs::create_dir(&folder).unwrap();
    for (name, text) in [
        (
            "agentBehavior",
            "function [i, c] = agentBehavior()\ni = @oneInit;\nc = @oneCallback;\nend\n",
        ),
        (
            "oneInit",
            "global aux;\nassert(isequal(size(aux.minJointAngles), [1 7]));\naux.initJointAngles = zeros(1, 7);\n",
        ),
        (
            "oneCallback",
            "global sensor motor;\nassert(isequal(size(sensor.jointAngles), [1 7]));\nmotor.jointVelocities(1, 1) = 0.25;\n",
        ),
    ] {
        fs::write(folder.join(name).with_extension("m"), text).unwrap();
    }
    let script = format!("octave:{}", folder.display());
    let robot = after_a_second_of(&script, "octave");
    assert_near(angle(&robot, 0), 0.25);
    // The fourth joint cannot be straight.
    assert_near(angle(&robot, 3), -0.0698);
}
