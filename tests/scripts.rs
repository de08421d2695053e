//! Scripts that drive the robot, as a user runs them: the examples do what they are for, in a real Octave and a real Python.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    f64::consts::FRAC_PI_2,
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use bevy::{ecs::message::MessageCursor, math::Vec3, prelude::*};
use serde_json::Value;
use tabletop::{
    camera::Camera,
    core::{Agent, AgentNews, AgentOrder, HeadCamera, Markers, RobotJoint, TICK_SECONDS, Table},
    prelude::*,
    scenario::{Outcome, Program, Scenario, ScenarioPlugin, ScenarioRun},
    script::{EngineChoice, ScriptPlugin, ScriptSettings},
    xml::read_task,
};

/// Runs the program without a display, in the folder of this package.
fn tabletop(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tabletop"));
    command
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("TABLETOP_ENGINE");
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn succeeded(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

/// A place for a test's files; what an earlier run has left there is gone.
fn place(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("scripts")
        .join(name);
    let _not_there = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// A copy of the folder matlab, whose agentBehavior.m names this pair.
fn copy_of_matlab(pair: &str) -> PathBuf {
    let folder = place(pair);
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("matlab");
    for entry in fs::read_dir(source).unwrap() {
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

/// `--script` for the scripts of a folder in Octave.
fn octave(folder: &Path) -> String {
    format!("octave:{}", folder.display())
}

fn angles(robot: &Value, arm: &str) -> Vec<f64> {
    let angles = robot[arm]["angles"].as_array().unwrap();
    angles.iter().map(|angle| angle.as_f64().unwrap()).collect()
}

/// A simulator whose robot is driven by an example.
struct Stage {
    app: App,
    news: MessageCursor<AgentNews>,
    printed: String,
    is_over: bool,
}

impl Stage {
    fn new(pair: &str, scenario: Option<&str>) -> Self {
        let Ok(engine) = "octave".parse::<EngineChoice>();
        let settings = ScriptSettings {
            engine,
            agent: Some(copy_of_matlab(pair)),
            ..default()
        };
        let plugins = TabletopSimPlugins.build().set(ScriptPlugin { settings });
        let mut app = headless_app_with((plugins, ScenarioPlugin));
        if let Some(name) = scenario {
            let path = Path::new(env!("CARGO_MANIFEST_DIR"))
                .join("tests/scripts")
                .join(name);
            let scenario = Scenario::read(path).unwrap();
            let read = |file: &Path| Ok(read_task(file).map_err(|error| error.to_string())?.scene);
            app.insert_resource(ScenarioRun::new(Program::new(&scenario, read, 0).unwrap()));
        } else {
            app.world_mut()
                .write_message(SimCommand::SetScene(Box::default()));
        }
        app.world_mut().write_message(AgentOrder::Start);
        let mut stage = Self {
            app,
            news: MessageCursor::default(),
            printed: String::new(),
            is_over: false,
        };
        stage.tick();
        let agent = stage.app.world().resource::<Agent>();
        assert!(
            matches!(agent, Agent::Online { .. }),
            "these tests need GNU Octave (octave-cli): {agent:?}"
        );
        stage
    }

    fn tick(&mut self) {
        self.app.step(1);
        let messages = self.app.world().resource::<Messages<AgentNews>>();
        for news in self.news.read(messages) {
            match news {
                AgentNews::Printed { line, .. } => self.printed += &format!("{line}\n"),
                AgentNews::Failed { reason } => panic!("{reason}"),
                AgentNews::Stopped => self.is_over = true,
                AgentNews::Started { .. } => {}
            }
        }
    }

    fn hand(&self) -> Vec3 {
        self.app
            .world()
            .resource::<Robot>()
            .arm(Arm::Right)
            .end_effector
            .location
    }

    /// How near the right hand gets to each marker until the script has exited.
    fn nearest(&mut self, mut begin: impl FnMut(&Self) -> bool) -> Vec<f32> {
        let markers = self.app.world().resource::<Markers>().0.clone();
        assert!(!markers.is_empty());
        let mut nearest = vec![f32::MAX; markers.len()];
        let mut begun = false;
        for _ in 0..60 * 120 {
            self.tick();
            begun = begun || begin(self);
            if begun {
                for (nearest, marker) in nearest.iter_mut().zip(&markers) {
                    *nearest = nearest.min(marker.distance(self.hand()));
                }
            }
            if self.is_over {
                return nearest;
            }
        }
        panic!("it does not end: {nearest:?} {}", self.printed);
    }
}

/// What five seconds at 0.5 rad/s make of the angles of the init script. The tick of the init script comes before.
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
    tabletop(&[&run[..], &["--final-robot", "-"]].concat())
}

#[test]
fn the_example_turns_every_joint_for_five_seconds() {
    for script in ["matlab", "octave", "octave:matlab"] {
        let mut command = five_seconds_of(script);
        let output = command.env("TABLETOP_ENGINE", "octave").output().unwrap();
        assert_turned(&output);
        let printed = text(&output.stderr);
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

#[test]
fn the_python_example_turns_every_joint_for_five_seconds() {
    for script in ["python", "python:python/example.py"] {
        let mut command = five_seconds_of(script);
        let output = command.output().unwrap();
        assert_turned(&output);
        let printed = text(&output.stderr);
        assert!(printed.contains("tabletop: Python 3"), "{printed}");
        assert!(printed.contains("jointAngles"), "{printed}");
    }
}

#[test]
fn the_reaching_hand_gets_to_every_marker() {
    let nearest = Stage::new("reach", None).nearest(|_| true);
    assert_eq!(nearest.len(), 4);
    assert!(
        nearest.iter().all(|distance| *distance < 0.11),
        "{nearest:?}"
    );
}

#[test]
fn the_babbling_arm_learns_to_reach_and_remembers() {
    let mut stage = Stage::new("babble", None);
    let nearest = stage.nearest(|stage| stage.printed.contains("units; error"));
    assert_eq!(nearest.len(), 4);
    assert!(
        nearest.iter().all(|distance| *distance < 0.4),
        "{nearest:?}"
    );
    let line = stage
        .printed
        .lines()
        .find(|line| line.contains("units; error"))
        .unwrap();
    let words = line
        .split_whitespace()
        .filter_map(|word| word.parse::<f64>().ok());
    let errors: Vec<_> = words.filter(|number| *number < 1.0).collect();
    assert!(errors[1] < 0.7 * errors[0], "the error falls: {line}");
    let folder = stage
        .app
        .world()
        .resource::<ScriptSettings>()
        .agent
        .clone()
        .unwrap();
    assert!(folder.join("babble.mat").exists());
}

#[test]
fn the_head_keeps_the_red_block_near_the_middle_of_its_picture() {
    let mut stage = Stage::new("follow", Some("follow.ron"));
    let (mut ticks, mut widest, mut turned) = (0, 0.0_f32, (0.0_f32, 0.0_f32));
    while *stage.app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
        stage.tick();
        ticks += 1;
        let world = stage.app.world();
        let Some(block) = world.resource::<ObjectIndex>().get("RedBlock") else {
            continue;
        };
        let head = world.resource::<HeadCamera>();
        let camera = Camera::of_head(head, &Table::default());
        let pixel = camera.pixel_of(world.get::<Transform>(block).unwrap().translation);
        turned = (turned.0.min(head.pan), turned.1.max(head.pan));
        // For two seconds it may look for the block.
        if ticks > 120 {
            widest = widest.max((pixel.unwrap().x - 99.5).abs());
        }
    }
    let outcome = stage.app.world().resource::<ScenarioRun>().outcome();
    assert_eq!(*outcome, Outcome::Done);
    assert!(widest < 35.0, "{widest} columns from the middle");
    assert!(turned.0 < -0.5 && turned.1 > 0.4, "{turned:?}");
}

#[test]
fn demonstrations_become_pictures() {
    let mut stage = Stage::new("record", Some("demonstrate.ron"));
    while *stage.app.world().resource::<ScenarioRun>().outcome() == Outcome::Running {
        stage.tick();
    }
    let folder = stage
        .app
        .world()
        .resource::<ScriptSettings>()
        .agent
        .clone()
        .unwrap();
    let mut pictures: Vec<_> = fs::read_dir(folder.join("pictures"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    pictures.sort();
    // Two seconds, four pictures a second.
    assert_eq!(pictures.len(), 8, "{pictures:?}");
    let decoder = png::Decoder::new(std::io::BufReader::new(
        fs::File::open(&pictures[0]).unwrap(),
    ));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (200, 150));
    let is_red = |pixel: &[u8]| pixel[0] > 120 && pixel[1] < 80 && pixel[2] < 80;
    assert!(pixels.chunks_exact(3).filter(|pixel| is_red(pixel)).count() > 100);
}

/// Files of a run of the pick-and-place example.
fn pick(name: &str, script: &str) -> [PathBuf; 3] {
    let folder = place(name);
    let files = ["recording", "state.csv", "robot.json"].map(|name| folder.join(name));
    let [recording, state, robot] = files.each_ref().map(|path| path.to_str().unwrap());
    let mut command = tabletop(&["run", "tests/scripts/pick.ron", "--script", script]);
    command.args([
        "--record",
        recording,
        "--final-state",
        state,
        "--final-robot",
        robot,
    ]);
    succeeded(&command.output().unwrap());
    files
}

#[test]
fn a_block_is_gripped_carried_and_put_on_another_the_same_every_time_and_without_the_script() {
    let script = octave(&copy_of_matlab("pick"));
    let [recording, first @ ..] = pick("first", &script);
    let [_, second @ ..] = pick("second", &script);
    for (first, second) in first.iter().zip(&second) {
        assert_eq!(fs::read(first).unwrap(), fs::read(second).unwrap());
    }
    // What was recorded runs again where there is no engine.
    let output = tabletop(&["replay", recording.to_str().unwrap(), "--verify"])
        .env("PATH", "")
        .output()
        .unwrap();
    succeeded(&output);
}

#[test]
fn with_motors_scripts_sense_and_order_torques() {
    let folder = place("torques");
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
    let output = tabletop(&run).arg("--dynamic").output().unwrap();
    succeeded(&output);
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    let [left, right] = ["left", "right"].map(|arm| angles(&robot, arm));
    assert!(right[6] > 0.5, "the wrist has turned: {right:?}");
    assert!(
        (left[6] - RobotJoint::LeftW2.home()).abs() < 0.1,
        "{left:?}"
    );
    // Where nothing is moved by forces, there are none to sense.
    let output = tabletop(&run).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("torquesCallback.m:1"));
}

#[test]
fn an_error_of_a_script_ends_the_run_with_its_place() {
    let folder = place("wrong");
    name_pair(&folder, "wrong");
    fs::write(folder.join("wrongInit.m"), "x = 1;").unwrap();
    fs::write(
        folder.join("wrongCallback.m"),
        "y = 2;\nz = nobody_knows + y;\n",
    )
    .unwrap();
    let script = octave(&folder);
    let output = tabletop(&[
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
    let printed = text(&output.stderr);
    assert!(printed.contains("'nobody_knows' undefined"), "{printed}");
    assert!(printed.contains("wrongCallback.m:2"), "{printed}");
    let robot: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(angles(&robot, "left")[0], RobotJoint::LeftS0.home());
}

#[test]
fn what_cannot_be_run_is_told() {
    for (arguments, message) in [
        (&["ruby:x.rb"][..], "expected matlab, octave or python"),
        (&["octave:no/such/folder"], "there is no "),
        (&["python:no_such.py"], "there is no "),
        (
            &["matlab", "--engine", "no/such/octave"],
            "there is no program no/such/octave",
        ),
        (
            &["matlab", "--engine", "ruby"],
            "the engine \"ruby\" is not known",
        ),
    ] {
        let mut command = tabletop(&["run", "--seconds", "1", "--script"]);
        let output = command.args(arguments).output().unwrap();
        assert_ne!(output.status.code(), Some(0), "{arguments:?}");
        let printed = text(&output.stderr);
        assert!(printed.contains(message), "{arguments:?}: {printed}");
    }
}
