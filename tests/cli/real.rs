//! `tabletop run --shadow` and `--real`, beside a mock robot behind a mock rosbridge server.

#[path = "../../crates/robot/tabletop_bridge/tests/rosbridge/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod mock;

use std::fs;

use mock::{MockServer, Trouble};
use tabletop::core::RobotLayout;

use crate::support::{command, place, stderr, stdout, tabletop};

/// A Baxter that stands as the simulated one does at first.
fn baxter() -> MockServer {
    let server = MockServer::start("baxter");
    for joint in &RobotLayout::baxter().joints {
        let mut robot = server.robot();
        if robot.angles.contains_key(&joint.urdf_name) {
            robot.angles.insert(joint.urdf_name.clone(), joint.home);
        }
    }
    server
}

/// A script that turns the joint S0 of both arms, and ends after a second.
fn turning_script(name: &str) -> String {
    let file = place(name);
    let text = "
time = 0.0
def init(aux):
    pass
def callback(sensor, motor, aux):
    global time
    time += sensor.timeElapsed
    motor.jointVelocities = [[0.3] + [0.0] * 6] * 2
    if time > 1:
        print('turned to', sensor.jointAngles[0][0], hasattr(sensor, 'objects'))
        aux.exit = True
";
    fs::write(&file, text).unwrap();
    format!("python:{}", file.to_str().unwrap())
}

#[test]
fn a_real_robot_is_followed_and_recorded() {
    let server = baxter();
    let home = server.robot().angles["left_s0"];
    server.robot().angles.insert("left_s0".into(), home + 0.25);
    let demo = place("real_shadow");
    let demo = demo.to_str().unwrap();
    let address = server.address().to_string();
    let arguments = [
        "run",
        "--shadow",
        &address,
        "--seconds",
        "1",
        "--record",
        demo,
    ];
    let output = tabletop(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let session = fs::read_to_string(format!("{demo}/session.jsonl")).unwrap();
    assert!(
        session.contains(&format!("\"real\":\"{address}\"")),
        "{session}"
    );
    let joints = fs::read_to_string(format!("{demo}/joints.csv")).unwrap();
    let mut rows = joints
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let last = rows.rfind(|row| row[1] == "left_s0").unwrap();
    let angle: f64 = last[2].parse().unwrap();
    assert!((angle - home - 0.25).abs() < 1e-3, "{angle}");
    // It was sent nothing.
    assert!(server.robot().modes.is_empty());
}

#[test]
fn a_script_moves_a_real_robot_as_the_simulated_one() {
    let server = baxter();
    let home = ["left_s0", "right_s0"].map(|joint| server.robot().angles[joint]);
    let script = turning_script("real_turning.py");
    let address = server.address().to_string();
    let arguments = [
        "run", "--real", &address, "--arms", "left", "--script", &script,
    ];
    let refused = tabletop(&arguments);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("--yes"), "{}", stderr(&refused));
    assert!(server.robot().modes.is_empty());

    let output = tabletop(&[&arguments[..], &["--yes"]].concat());
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stdout(&output));
    let turned = said
        .lines()
        .find_map(|line| line.split("turned to ").nth(1));
    let (angle, has_objects) = turned.unwrap().split_once(' ').unwrap();
    let way = angle.parse::<f64>().unwrap() - home[0];
    // Where ticks are late, a second of the script takes longer.
    assert!((0.15..1.0).contains(&way), "{way}");
    assert_eq!(has_objects, "False");
    assert!(said.contains("the real robot rests"), "{said}");
    assert_eq!(server.robot().angles["right_s0"], home[1]);
}

#[test]
fn an_emergency_stop_ends_the_run_with_its_reason() {
    let server = baxter();
    let script = turning_script("real_stopped.py");
    let address = server.address().to_string();
    let arguments = ["run", "--real", &address, "--yes", "--script", &script];
    let run = command(&arguments)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let home = server.robot().angles["left_s0"];
    let start = std::time::Instant::now();
    while (server.robot().angles["left_s0"] - home).abs() < 0.02 {
        assert!(start.elapsed().as_secs() < 60, "it does not move");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    server.robot().trouble = Trouble::EmergencyStop;
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("a person must reset it"),
        "{}",
        stderr(&output)
    );
}

/// A script that turns the first joint of each arm for long.
fn lasting_script(name: &str, arms: usize) -> String {
    let file = place(name);
    let text = format!(
        "
def init(aux):
    pass
def callback(sensor, motor, aux):
    motor.jointVelocities = [[0.3] + [0.0] * 6] * {arms}
"
    );
    fs::write(&file, text).unwrap();
    format!("python:{}", file.to_str().unwrap())
}

/// Waits until a joint has turned on from where it begins, and no longer than a minute.
fn wait_for_motion(server: &MockServer, joint: &str) {
    let home = server.robot().angles[joint];
    let start = std::time::Instant::now();
    while (server.robot().angles[joint] - home).abs() < 0.05 {
        assert!(start.elapsed().as_secs() < 60, "it does not move");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

#[cfg(unix)]
fn signal(run: &std::process::Child, signal: &str) {
    let mut kill = std::process::Command::new("kill");
    kill.args([format!("-{signal}"), run.id().to_string()]);
    assert!(kill.status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn a_signal_brings_the_arm_to_rest_and_the_recording_is_whole() {
    let server = baxter();
    let script = lasting_script("real_interrupted.py", 2);
    let address = server.address().to_string();
    let demo = place("real_interrupted");
    let demo = demo.to_str().unwrap();
    let arguments = [
        "run",
        "--real",
        &address,
        "--yes",
        "--script",
        &script,
        "--seconds",
        "60",
        "--record",
        demo,
    ];
    let run = command(&arguments)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    wait_for_motion(&server, "left_s0");
    signal(&run, "INT");
    let output = run.wait_with_output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("Ctrl-C ended the program"), "{said}");
    // Held by position, not left to its time limit.
    assert_eq!(server.robot().modes.last(), Some(&1));
    // It is whole, and shows nothing but motions of the robot.
    let checked = stdout(&tabletop(&["dataset", "check", demo]));
    let no_task = format!("{demo}: its task is empty: nothing is moved for good\n");
    assert_eq!(checked, no_task + "1 episode, 1 fault.\n");
}

#[cfg(unix)]
#[test]
fn a_panda_rests_when_its_program_is_killed() {
    let server = MockServer::start("panda");
    let script = lasting_script("real_killed.py", 1);
    let address = server.address().to_string();
    let arguments = [
        "run",
        "--real",
        &address,
        "--yes",
        "--script",
        &script,
        "--seconds",
        "60",
    ];
    let mut run = command(&arguments).spawn().unwrap();
    wait_for_motion(&server, "panda_joint1");
    let before = server.robot().angles["panda_joint1"];
    signal(&run, "KILL");
    run.wait().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    let rest = server.robot().angles["panda_joint1"];
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(server.robot().angles["panda_joint1"], rest);
    assert!((rest - before).abs() < 0.1, "{before} {rest}");
}
