//! Scripts on the command line.

use std::{
    f64::consts::FRAC_PI_2,
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use serde_json::Value;
use tabletop::{
    core::{RobotJoint, TICK_SECONDS},
    prelude::*,
};
use tabletop_harness::test_with;

use crate::support::{command, place, scenario, shipped, stderr, stdout, tabletop};

fn succeeded(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
}

/// An empty folder for scripts and their results.
fn folder(name: &str) -> PathBuf {
    let folder = place(&format!("scripts-{name}"));
    fs::create_dir(&folder).unwrap();
    folder
}

/// A copy of the folder matlab, whose agentBehavior.m names this pair.
pub fn copy_of_matlab(pair: &str) -> PathBuf {
    let folder = folder(pair);
    for entry in fs::read_dir("matlab").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "m") {
            fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
    }
    name_pair(&folder, pair);
    folder
}

fn name_pair(folder: &Path, pair: &str) {
    let behavior =
        format!("function [i, c] = agentBehavior()\ni = @{pair}Init;\nc = @{pair}Callback;\nend\n");
    fs::write(folder.join("agentBehavior.m"), behavior).unwrap();
}

/// `--script` for a Python script of these two functions, in an empty folder.
fn python(name: &str, init: &str, callback: &str) -> String {
    let file = folder(name).join("robot.py");
    let text = format!(
        "import os, time\ndef init(aux):\n    {init}\ndef callback(sensor, motor, aux):\n    {callback}\n"
    );
    fs::write(&file, text).unwrap();
    format!("python:{}", file.display())
}

/// `--script` for the scripts of a folder in Octave.
fn octave(folder: &Path) -> String {
    format!("octave:{}", folder.display())
}

fn angles(robot: &Value, arm: &str) -> Vec<f64> {
    let angles = robot[arm]["angles"].as_array().unwrap();
    angles.iter().map(|angle| angle.as_f64().unwrap()).collect()
}

/// Angles of the init script after five seconds at 0.5 rad/s. The tick of the init script comes before.
fn turned(joint: RobotJoint) -> f64 {
    let begin = if joint == RobotJoint::RightE0 {
        FRAC_PI_2
    } else {
        0.0
    };
    (0..300).fold(begin, |angle, _| {
        joint.clamp(angle + 0.5 * f64::from(TICK_SECONDS))
    })
}

fn assert_turned(output: &Output) {
    succeeded(output);
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    for (arm, name) in [(Arm::Left, "left"), (Arm::Right, "right")] {
        for (joint, angle) in RobotJoint::of_arm(arm)
            .into_iter()
            .zip(angles(&robot, name))
        {
            assert!((angle - turned(joint)).abs() < 1e-12, "{joint}: {angle}");
        }
        assert_eq!(robot[name]["gripper_opening"], 0.0);
    }
}

fn five_seconds_of(script: &str) -> Command {
    let run = ["run", "--script", script, "--seconds", "5"];
    command(&[&run[..], &["--final-robot", "-"]].concat())
}

#[test_with(Python)]
fn a_script_watches_a_replay_and_then_acts() {
    let demo = place("watched");
    let scenario = shipped("scenarios", "stack_two_blocks.ron");
    let [demo, scenario] = [&demo, &scenario].map(|path| path.to_str().unwrap());
    let recorded = tabletop(&["run", scenario, "--record", demo]);
    assert_eq!(recorded.status.code(), Some(0), "{}", stderr(&recorded));
    let script = place("watcher.py");
    let text = "seen = acted = 0
def init(aux): pass
def callback(sensor, motor, aux):
    global seen, acted
    motor.jointVelocities = [[0.1] * 7] * 2
    if sensor.demoCue:
        seen += 1
        assert acted == 0
        start = sensor.jointAngles[0][0]
        assert abs(start - 0.25) < 1e-9, start
    else:
        acted += 1
        if acted == 30:
            print('saw', seen, 'ticks, moved by', round(float(sensor.jointAngles[0][0]) - 0.25, 3))
";
    fs::write(&script, text).unwrap();
    let script = format!("python:{}", script.to_str().unwrap());
    let output = tabletop(&["replay", demo, "--script", &script, "--seconds", "1"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("saw ") && said.contains("moved by 0.0"),
        "{said}"
    );
}

#[test_with(Octave)]
fn the_example_turns_every_joint_for_five_seconds() {
    for script in ["matlab", "octave", "octave:matlab"] {
        let mut run = five_seconds_of(script);
        let output = run.env("TABLETOP_ENGINE", "octave").output().unwrap();
        assert_turned(&output);
        let printed = stderr(&output);
        for name in [
            "tabletop: GNU Octave",
            "minJointAngles",
            "initJointAngles",
            "endEffPos",
            "gripperVelocities",
        ] {
            assert!(printed.contains(name), "{name}: {printed}");
        }
    }
}

#[test_with(Python)]
fn the_python_example_turns_every_joint_for_five_seconds() {
    for script in ["python", "python:python/example.py"] {
        let mut run = five_seconds_of(script);
        let output = run.output().unwrap();
        assert_turned(&output);
        let printed = stderr(&output);
        assert!(printed.contains("tabletop: Python 3"), "{printed}");
        assert!(printed.contains("jointAngles"), "{printed}");
    }
}

/// Files of a run of the pick-and-place example.
fn pick(name: &str, script: &str) -> [PathBuf; 3] {
    let folder = folder(name);
    let files = ["recording", "state.csv", "robot.json"].map(|name| folder.join(name));
    let [recording, state, robot] = files.each_ref().map(|path| path.to_str().unwrap());
    let mut run = command(&["run", "tests/scripts/pick.ron", "--script", script]);
    run.args([
        "--record",
        recording,
        "--final-state",
        state,
        "--final-robot",
        robot,
    ]);
    succeeded(&run.output().unwrap());
    files
}

#[test_with(Octave)]
fn a_block_is_gripped_carried_and_put_on_another_the_same_every_time_and_without_the_script() {
    let script = octave(&copy_of_matlab("pick"));
    let [recording, first @ ..] = pick("first", &script);
    let [_, second @ ..] = pick("second", &script);
    for (first, second) in first.iter().zip(&second) {
        assert_eq!(fs::read(first).unwrap(), fs::read(second).unwrap());
    }
    // The recording replays without any engine.
    let output = command(&["replay", recording.to_str().unwrap(), "--verify"])
        .env("PATH", "")
        .output()
        .unwrap();
    succeeded(&output);
}

#[test_with(Octave)]
fn with_motors_scripts_sense_and_order_torques() {
    let folder = folder("torques");
    name_pair(&folder, "torques");
    fs::write(folder.join("torquesInit.m"), "").unwrap();
    let callback = "motor.jointTorques = sensor.jointTorques;\nmotor.jointTorques(2, 7) = 1;\n";
    fs::write(folder.join("torquesCallback.m"), callback).unwrap();
    let script = octave(&folder);
    let run = [
        "run",
        "--script",
        &script,
        "--seconds",
        "1",
        "--final-robot",
        "-",
    ];
    let output = command(&run).arg("--dynamic").output().unwrap();
    succeeded(&output);
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    let [left, right] = ["left", "right"].map(|arm| angles(&robot, arm));
    assert!(right[6] > 0.5, "the wrist has turned: {right:?}");
    assert!(
        (left[6] - RobotJoint::LeftW2.home()).abs() < 0.1,
        "{left:?}"
    );
    // If no forces move anything, there are none to sense.
    let output = command(&run).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("torquesCallback.m:1"));
}

#[test_with(Octave)]
fn an_error_of_a_script_ends_the_run_with_its_place() {
    let folder = folder("wrong");
    name_pair(&folder, "wrong");
    fs::write(folder.join("wrongInit.m"), "x = 1;").unwrap();
    fs::write(
        folder.join("wrongCallback.m"),
        "y = 2;\nz = nobody_knows + y;\n",
    )
    .unwrap();
    let script = octave(&folder);
    let output = command(&[
        "run",
        "--script",
        &script,
        "--seconds",
        "5",
        "--final-robot",
        "-",
    ])
    .output()
    .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let printed = stderr(&output);
    assert!(printed.contains("'nobody_knows' undefined"), "{printed}");
    assert!(printed.contains("wrongCallback.m:2"), "{printed}");
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(angles(&robot, "left")[0], RobotJoint::LeftS0.home());
}

#[test_with(Octave, Python)]
fn scripts_that_cannot_run_are_reported_before_anything_starts() {
    let file = folder("file-for-folder").join("robot.py");
    fs::write(&file, "").unwrap();
    let matlab_file = format!("octave:{}", file.display());
    let python_folder = format!("python:{}", file.parent().unwrap().display());
    for (arguments, message) in [
        (&["octave:no/such/folder"][..], "there is no "),
        (&["python:no_such.py"], "there is no "),
        (&["python:"], "the name of the Python file is empty"),
        (&["octave:"], "the name of the scripts' folder is empty"),
        (&[&matlab_file], "robot.py is a file; name its folder"),
        (&[&python_folder], "is a folder; name the Python file in it"),
        (
            &["matlab", "--engine", "no/such/octave"],
            "--engine: there is no program no/such/octave",
        ),
        (
            &["matlab", "--engine", "ruby-9"],
            "--engine: there is no program \"ruby-9\" on PATH",
        ),
        (
            &["matlab", "--engine", "tests/scripts/driver.pl"],
            "driver.pl is a program, but its name does not identify its engine",
        ),
        (
            &["python", "--engine", "octave"],
            "--script python cannot run in GNU Octave, which --engine names; say --engine python",
        ),
        (
            &["matlab", "--engine", "python"],
            "--script matlab cannot run in Python, which --engine names; say --engine matlab or --engine octave",
        ),
        (
            &["other:tests/scripts/driver.pl"],
            "--script other needs --engine",
        ),
        (
            &["other:no.pl", "--engine", "tests/scripts/driver.pl"],
            "there is no ",
        ),
    ] {
        let mut run = command(&["run", "--seconds", "1", "--script"]);
        let output = run.args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let printed = stderr(&output);
        assert!(printed.contains(message), "{arguments:?}: {printed}");
        assert_eq!(printed.lines().count(), 1, "{arguments:?}: {printed}");
    }
}

#[test_with(Perl)]
fn a_driver_of_ones_own_runs_scripts_in_other_languages() {
    let driver = "tests/scripts/driver.pl";
    let script = format!("other:{driver}");
    let output = tabletop(&[
        "run",
        "--script",
        &script,
        "--engine",
        driver,
        "--seconds",
        "1",
        "--final-robot",
        "-",
    ]);
    succeeded(&output);
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    let pan = robot["head_pan"].as_f64().unwrap();
    assert!((pan - 0.5).abs() < 1e-6, "{pan}");
}

#[test_with(Octave, Python)]
fn the_named_engine_runs_the_script() {
    let script = python("named-engine", "print(os.environ['NAMED'])", "pass");
    let program = folder("my-python").join("python-of-mine");
    fs::write(&program, "#!/bin/sh\nNAMED=mine exec python3 \"$@\"\n").unwrap();
    let made = Command::new("chmod").arg("+x").arg(&program).status();
    assert!(made.unwrap().success());
    let run = || command(&["run", "--seconds", "0.1", "--script", &script]);
    let by_option = run().arg("--engine").arg(&program).output().unwrap();
    let by_variable = run().env("TABLETOP_ENGINE", &program).output().unwrap();
    for output in [by_option, by_variable] {
        succeeded(&output);
        assert!(stderr(&output).contains("\nmine\n"), "{}", stderr(&output));
    }
    let another = run().env("TABLETOP_ENGINE", "octave").output().unwrap();
    assert_eq!(another.status.code(), Some(2));
    assert!(stderr(&another).contains("GNU Octave, which TABLETOP_ENGINE names"));
    let missing = run().env("TABLETOP_ENGINE", "matlab").output().unwrap();
    let advice = "MATLAB, which TABLETOP_ENGINE names; say --engine python";
    assert!(stderr(&missing).contains(advice), "{}", stderr(&missing));
    let wrong = run().env("TABLETOP_ENGINE", "/no/python").output().unwrap();
    let reason = "tabletop: TABLETOP_ENGINE: there is no program /no/python\n";
    assert_eq!(stderr(&wrong), reason);
}

#[test_with(Python)]
fn any_engine_is_taken_if_the_option_says_so() {
    let script = python("auto", "pass", "aux.exit = True");
    let mut command = command(&["run", "--script", &script, "--engine", "auto"]);
    let output = command
        .env("TABLETOP_ENGINE", "/no/octave")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test_with(Python)]
fn a_script_that_fails_beside_a_scenario_is_reported_once_when_it_does() {
    let script = python("beside", "pass", "raise ValueError('my bug')");
    for (name, steps, end) in [
        ("beside_done.ron", "Wait(0.2)", ""),
        (
            "beside_failed.ron",
            "Wait(0.2), Expect(Robot(Joint(joint: HeadPan, at: 1)))",
            "beside_failed.ron:2:",
        ),
    ] {
        let scenario = scenario(name, steps);
        let output = tabletop(&["run", scenario.to_str().unwrap(), "--script", &script]);
        let printed = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{printed}");
        assert_eq!(
            printed
                .matches("tabletop: ValueError: my bug\n  at ")
                .count(),
            1
        );
        let after = printed.split("my bug").nth(1).unwrap();
        assert!(after.contains(end), "{printed}");
    }
}

#[test_with(Python)]
fn printed_lines_are_shown_while_the_script_runs() {
    let go = folder("progress").join("go");
    let wait = format!("print('halfway')\n    while not os.path.exists({go:?}): time.sleep(0.01)");
    let script = python("progress-script", &wait, "aux.exit = 1");
    let mut run = command(&["run", "--quiet", "--script", &script])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(run.stderr.take().unwrap()).lines();
    assert!(
        lines
            .next()
            .unwrap()
            .unwrap()
            .starts_with("tabletop: Python 3")
    );
    assert_eq!(lines.next().unwrap().unwrap(), "halfway");
    fs::write(go, "").unwrap();
    assert_eq!(lines.count(), 0);
    assert!(run.wait().unwrap().success());
}

#[test_with(Octave)]
fn lines_printed_at_the_end_are_shown_and_files_are_whole() {
    let folder = copy_of_matlab("last");
    fs::write(
        folder.join("lastInit.m"),
        "log = fopen([aux.path 'log.txt'], 'w'); n = 0; farewell = onCleanup(@() disp('farewell'));",
    )
    .unwrap();
    let calls = "n = n + 1; fprintf(log, 'x');";
    for end in [
        "",
        "if n == 30, aux.exit = 1; end",
        "if n == 30, error('no'), end",
    ] {
        fs::write(folder.join("lastCallback.m"), format!("{calls} {end}")).unwrap();
        let output = tabletop(&["run", "--seconds", "0.5", "--script", &octave(&folder)]);
        assert!(
            stderr(&output).contains("farewell\n"),
            "{}",
            stderr(&output)
        );
        let log = fs::read_to_string(folder.join("log.txt")).unwrap();
        assert_eq!(log.len(), 30, "{end}");
    }
}

#[test_with(Python)]
fn the_time_limit_is_for_init_as_well() {
    let script = python("endless", "while True: pass", "pass");
    let output = tabletop(&["run", "--script", &script, "--script-timeout", "0.5"]);
    assert_eq!(output.status.code(), Some(1));
    let reason = "no answer from the init script within 0.5 s";
    assert!(stderr(&output).contains(reason), "{}", stderr(&output));
}

#[test_with(Python)]
fn markers_nobody_can_see_are_the_scripts_fault_and_not_the_scenarios() {
    let script = python(
        "far",
        "aux.drawMarkers = [[1, 2, 3], [0, -1e39, 0]]",
        "pass",
    );
    let scenario = scenario("far.ron", "Wait(0.2)");
    let reason = "aux.drawMarkers[1][1] is -1e39; it must be";
    for beside in [None, scenario.to_str()] {
        let run = ["run", "--quiet", "--seconds", "1", "--script", &script];
        let output = command(&run).args(beside).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let printed = stderr(&output);
        assert!(printed.contains(reason), "{printed}");
        assert!(!printed.contains("far.ron"), "{printed}");
    }
}

#[test_with(Python)]
fn a_scenario_may_pause_while_a_script_runs() {
    let script = python("paused", "pass", "motor.jointAngles = [[0] * 7] * 2");
    let scenario = scenario(
        "paused.ron",
        "Wait(0.1), Pause(true), Wait(0.1), Pause(false)",
    );
    succeeded(&tabletop(&[
        "run",
        scenario.to_str().unwrap(),
        "--script",
        &script,
    ]));
}

#[test_with(Python)]
fn a_run_that_nobody_listens_to_ends_quietly() {
    let script = python("chatty", "pass", "print('on and on')");
    let mut run = command(&["run", "--seconds", "10000", "--script", &script])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(run.stderr.take().unwrap()).lines();
    assert!(lines.next().unwrap().is_ok());
    drop(lines);
    assert_eq!(run.wait().unwrap().code(), Some(1));
}

#[test_with(Python)]
fn angles_that_no_joint_has_are_noted() {
    let script = python("too-far", "aux.initJointAngles = [[99] * 7] * 2", "pass");
    let output = tabletop(&["run", "--seconds", "0.1", "--script", &script]);
    succeeded(&output);
    let note = "tabletop: aux.initJointAngles wants left_s0 at 99; it is moved to";
    assert!(stderr(&output).contains(note), "{}", stderr(&output));
}

#[test_with(Python)]
fn torques_that_nothing_obeys_are_noted_once() {
    let script = python("no-motors", "pass", "motor.jointTorques = [[0] * 7] * 2");
    let run = ["run", "--seconds", "0.1", "--script", &script];
    let output = tabletop(&run);
    succeeded(&output);
    let note = "tabletop: motor.jointTorques has no effect without --dynamic";
    assert_eq!(stderr(&output).matches(note).count(), 1);
    let output = command(&run).arg("--dynamic").output().unwrap();
    assert!(!stderr(&output).contains(note));
}

#[test_with(Octave)]
fn a_pair_of_scripts_is_named_on_the_command_line() {
    let folder = copy_of_matlab("example");
    let named = format!("{}#reach", octave(&folder));
    let run = ["run", "--seconds", "1", "--show-robot", "--script"];
    let output = command(&run).arg(&named).output().unwrap();
    succeeded(&output);
    let robot = |script: &str| {
        let run = ["run", "--seconds", "1", "--script", script];
        let output = tabletop(&[&run[..], &["--show-robot", "--final-robot", "-"]].concat());
        succeeded(&output);
        output.stdout
    };
    name_pair(&folder, "reach");
    assert_eq!(robot(&named), robot(&octave(&folder)));

    for (pair, reason) in [
        ("#grab", "there is no grabInit.m in"),
        ("#", "expected the name of a pair of scripts after #"),
    ] {
        let output = tabletop(&["run", "--script", &format!("{}{pair}", octave(&folder))]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
    let output = tabletop(&["run", "--script", "python:python/example.py#reach"]);
    let reason = "a Python file or a driver has no pairs";
    assert!(stderr(&output).contains(reason), "{}", stderr(&output));
}

/// `--script` for a script that ends itself after half a second.
fn half_a_second(name: &str) -> String {
    python(
        name,
        "global calls; calls = 0",
        "global calls; calls += 1; print('call', calls); calls < 30 or setattr(aux, 'exit', True)",
    )
}

#[test_with(Python)]
fn a_scenario_that_waits_for_nothing_lasts_as_long_as_its_script() {
    let scenario = scenario("shown.ron", "Robot(Show)");
    let run = |limit: &[&str], script: &str| {
        let run = ["run", scenario.to_str().unwrap(), "--script", script];
        let output = tabletop(&[&run[..], limit].concat());
        succeeded(&output);
        stderr(&output)
    };
    let cut = "the script was still running when the scenario ended";
    let whole = run(&[], &half_a_second("whole"));
    assert!(whole.contains("call 30"), "{whole}");
    assert!(!whole.contains(cut), "{whole}");
    let part = run(&["--seconds", "0.2"], &half_a_second("part"));
    assert!(
        part.contains("call 5") && !part.contains("call 15"),
        "{part}"
    );
    assert!(part.contains(cut), "{part}");
}

#[test_with(Python)]
fn a_scenario_that_ends_before_its_script_says_so() {
    let scenario = scenario("short.ron", "Wait(0.2)");
    let script = half_a_second("long");
    let output = tabletop(&["run", scenario.to_str().unwrap(), "--script", &script]);
    succeeded(&output);
    let printed = stderr(&output);
    assert!(!printed.contains("call 30"), "{printed}");
    let cut = "the script was still running when the scenario ended";
    assert_eq!(printed.matches(cut).count(), 1, "{printed}");
}

#[test_with(Python)]
fn a_script_knows_the_task_of_a_recording() {
    let demo = place("task_of_a_recording");
    let demo = demo.to_str().unwrap();
    let scenario = "shipped:scenarios/stack_three.ron";
    let output = tabletop(&["run", scenario, "--record", demo, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let script = "python:learners/follow_task.py";
    let output = tabletop(&["run", scenario, "--script", script, "--task", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let reported = stderr(&output) + &stdout(&output);
    for sentence in [
        "1. Put the green block on the blue block. Done.",
        "2. Put the red block on the green block. Done.",
    ] {
        assert!(reported.contains(sentence), "{reported}");
    }
}

#[test_with(Octave)]
fn a_script_that_never_ends_is_ended() {
    let folder = place("endless");
    fs::create_dir_all(&folder).unwrap();
    for (file, text) in [
        (
            "agentBehavior.m",
            "function [init, callback] = agentBehavior()\ninit = @endlessInit; callback = @endlessCallback;\nend\n",
        ),
        ("endlessInit.m", "aux.drawMarkers = [0 0 1];\n"),
        ("endlessCallback.m", "while true, end\n"),
    ] {
        fs::write(folder.join(file), text).unwrap();
    }
    let script = format!("octave:{}", folder.display());
    let output = tabletop(&["run", "--script", &script, "--script-timeout", "0.5"]);
    assert_eq!(output.status.code(), Some(1));
    let words = stderr(&output);
    assert!(words.contains("within 0.5 s"), "{words}");
}

/// Runs a shipped script for a moment in an empty folder.
fn anywhere(script: &str) -> String {
    let mut run = command(&["run", "--script", script, "--seconds", "0.2"]);
    let empty = folder(&format!("anywhere-{}", script.replace([':', '/'], "-")));
    let output = run.current_dir(empty).output().unwrap();
    succeeded(&output);
    stderr(&output)
}

#[test_with(Octave)]
fn shipped_scripts_run_in_a_temporary_folder() {
    let printed = anywhere("octave");
    assert!(printed.contains("minJointAngles"), "{printed}");
    assert!(printed.contains("in a temporary folder"), "{printed}");
}

#[test_with(Python)]
fn shipped_scripts_of_python_run_in_a_temporary_folder() {
    for script in ["python", "python:python/example.py"] {
        let printed = anywhere(script);
        assert!(printed.contains("jointAngles"), "{script}: {printed}");
        assert!(printed.contains("in a temporary folder"), "{printed}");
    }
}
