//! The robot on the command line.

use std::fs;

use serde_json::Value;

use crate::support::{place, scenario, shipped, stderr, stdout, tabletop};

const MOVE: &str =
    "Robot(Show), Robot(Move([(LeftS1, -0.5), (HeadPan, -0.2)])), Robot(WaitUntilStill(5)),";

/// State of the robot after these steps.
fn robot_after(name: &str, steps: &str, options: &[&str]) -> Value {
    let scenario = scenario(name, steps);
    let arguments = [
        &["run", scenario.to_str().unwrap(), "--final-robot", "-"],
        options,
    ];
    let output = tabletop(&arguments.concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

fn position(robot: &Value, arm: &str) -> Vec<f64> {
    let position = robot[arm]["end_effector"]["position"].as_array().unwrap();
    position.iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn how_the_robot_is_in_the_end_is_written_as_json() {
    let robot = robot_after("robot_moves.ron", MOVE, &[]);
    assert_eq!(robot["left"]["angles"][1], -0.5);
    assert_eq!(robot["head_pan"], -0.2);
    assert_eq!(robot["shown"], true);
    assert_eq!(robot["right"]["gripper_opening"], 2.0);
    assert_eq!(robot["left"]["holds"], Value::Array(Vec::new()));
}

#[test]
fn another_description_is_another_robot() {
    let usual = robot_after("usual_robot.ron", MOVE, &[]);
    let smile = robot_after(
        "smile_robot.ron",
        MOVE,
        &["--robot", "assets/baxter/baxter_smile.urdf"],
    );
    let [usual, smile] = [usual, smile].map(|robot| position(&robot, "left"));
    let apart = (0..3)
        .map(|i| (usual[i] - smile[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    assert!((0.05..0.3).contains(&apart), "{usual:?} and {smile:?}");
}

#[test]
fn motors_come_to_the_same_place() {
    let moved = robot_after("motors.ron", MOVE, &["--dynamic"]);
    let angle = moved["left"]["angles"][1].as_f64().unwrap();
    assert!((angle + 0.5).abs() < 0.01, "{angle}");
}

#[test]
fn an_invalid_description_is_wrong_input() {
    let file = place("no_robot.urdf");
    for (text, words) in [
        (None, "no such file"),
        (
            Some("<robot name=\"r\"><link name=\"a\"/></robot>"),
            "left_s0",
        ),
        (Some("hello"), "no_robot.urdf"),
    ] {
        if let Some(text) = text {
            fs::write(&file, text).unwrap();
        }
        let output = tabletop(&["run", "--robot", file.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
}

#[test]
fn a_mesh_that_is_not_there_is_reported_once() {
    let robot = place("no_mesh.urdf");
    let shipped = fs::read_to_string(shipped("assets", "baxter/baxter.urdf")).unwrap();
    let missing = shipped.replace("package://tabletop/wrist.shape.json", "missing.stl");
    fs::write(&robot, missing).unwrap();
    let path = scenario("no_mesh.ron", "Robot(Show), Start, Wait(0.5), Finish,");
    let folder = place("no_mesh");
    let [path, robot, folder] = [&path, &robot, &folder].map(|path| path.to_str().unwrap());
    let output = tabletop(&["run", path, "--robot", robot, "--record", folder, "--quiet"]);
    assert_eq!(output.status.code(), Some(0));
    let said = stderr(&output);
    let words = "WARN link left_wrist is shown by its collision shape: missing.stl";
    assert!(said.contains(words) && said.lines().count() == 1, "{said}");
}

#[test]
fn a_recording_with_another_robot_is_replayed_with_it() {
    let steps =
        format!("Start, {MOVE} Grasp(\"RedBlock\"), Wait(0.5), Release, Wait(0.2), Finish,");
    let scenario = scenario("smile_recorded.ron", &steps);
    let folder = place("smile_recording");
    let folder = folder.to_str().unwrap();
    let robot = ["--robot", "assets/baxter/baxter_smile.urdf", "--dynamic"];
    let run = ["run", scenario.to_str().unwrap(), "--record", folder];
    let output = tabletop(&[&run[..], &robot].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let replayed = tabletop(&["replay", folder, "--verify"]);
    assert_eq!(replayed.status.code(), Some(0), "{}", stderr(&replayed));
}

#[cfg(unix)]
#[test]
fn a_description_reaches_no_urdf_outside_of_its_folder() {
    use std::os::unix::fs::symlink;

    let place = place("robot_reach");
    let robot = place.join("robot");
    fs::create_dir_all(robot.join("urdf")).unwrap();
    let panda = |file: &str| fs::read_to_string(shipped("assets/panda", file)).unwrap();
    for inside in ["real.urdf", "urdf/deep.urdf", "../secret.urdf"] {
        fs::write(robot.join(inside), panda("panda.urdf")).unwrap();
    }
    symlink("real.urdf", robot.join("other.urdf")).unwrap();
    symlink("../secret.urdf", robot.join("link.urdf")).unwrap();
    symlink("..", robot.join("up")).unwrap();
    let absolute = place.join("secret.urdf");
    let layout = robot.join("robot.ron");
    for (urdf, code, words) in [
        ("real.urdf", 0, ""),
        ("urdf/deep.urdf", 0, ""),
        ("other.urdf", 0, ""),
        ("link.urdf", 2, "leads out of its folder"),
        ("up/secret.urdf", 2, "leads out of its folder"),
        ("../secret.urdf", 2, "leads out of its folder"),
        (absolute.to_str().unwrap(), 2, "leads out of its folder"),
        ("missing.urdf", 2, "no such file"),
    ] {
        let named = format!("urdf: \"{urdf}\"");
        let text = panda("robot.ron").replace("urdf: \"panda.urdf\"", &named);
        fs::write(&layout, text).unwrap();
        let output = tabletop(&["robot", "check", "--robot", layout.to_str().unwrap()]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{urdf}: {said}");
        assert!(said.contains(words), "{urdf}: {said}");
    }
}

#[test]
fn a_first_description_is_written_checked_and_driven() {
    let folder = place("first_robot");
    fs::create_dir_all(folder.join("urdf")).unwrap();
    let urdf = folder.join("urdf/arm.urdf");
    let panda = fs::read_to_string(shipped("assets/panda", "panda.urdf")).unwrap();
    let panda = panda.replacen("effort=\"87\"", "", 1);
    fs::write(&urdf, panda.replace("package://tabletop/", "missing/")).unwrap();
    let (urdf, layout) = (urdf.to_str().unwrap(), folder.join("robot.ron"));
    let layout = layout.to_str().unwrap();

    let bare = tabletop(&["robot", "check", "--robot", urdf]);
    assert_eq!(bare.status.code(), Some(2));
    assert!(
        stdout(&bare).contains("limb panda: 7 joints"),
        "{}",
        stdout(&bare)
    );
    assert!(
        stderr(&bare).contains("tabletop robot new"),
        "{}",
        stderr(&bare)
    );

    let write = ["robot", "new", urdf, "--out", layout];
    let written = tabletop(&write);
    assert_eq!(written.status.code(), Some(0), "{}", stderr(&written));
    let text = fs::read_to_string(layout).unwrap();
    assert!(text.contains("urdf: \"urdf/arm.urdf\""), "{text}");
    let again = tabletop(&write);
    assert_eq!(again.status.code(), Some(2));
    assert!(
        stderr(&again).contains("not overwritten"),
        "{}",
        stderr(&again)
    );
    assert_eq!(fs::read_to_string(layout).unwrap(), text);
    let elsewhere = folder.join("urdf/deep");
    fs::create_dir_all(&elsewhere).unwrap();
    let elsewhere = elsewhere.join("robot.ron");
    let elsewhere = tabletop(&["robot", "new", urdf, "--out", elsewhere.to_str().unwrap()]);
    assert_eq!(elsewhere.status.code(), Some(2), "{}", stdout(&elsewhere));

    let checked = tabletop(&["robot", "check", "--robot", layout]);
    assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
    let said = stdout(&checked);
    let gap = said.lines().find(|line| line.contains("has no motor"));
    let gap = gap.unwrap_or_else(|| panic!("{said}"));
    assert!(
        gap.contains("arm.urdf: line ") && gap.contains("panda_joint1"),
        "{gap}"
    );
    assert!(said.ends_with("it can be driven\n"), "{said}");

    let steps = "Robot(Show), Robot(Move([(panda_joint1, 0.3)])), Robot(WaitUntilStill(5)),";
    let robot = robot_after("first_robot.ron", steps, &["--robot", layout]);
    assert_eq!(robot["panda"]["angles"][0], 0.3);
}

#[test]
fn the_robots_inside_the_program_lack_nothing() {
    for robot in ["baxter", "panda", "so101"] {
        let file = format!("assets/{robot}/robot.ron");
        let checked = tabletop(&["robot", "check", "--robot", &file]);
        assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
        assert!(
            !stdout(&checked).contains(": line "),
            "{}",
            stdout(&checked)
        );
    }
}

#[test]
fn the_low_cost_arm_builds_a_tower() {
    let setup = place("so101_blocks.xml");
    let block = |id: &str, x: f32, y: f32| {
        format!(
            "<block id=\"{id}\" location=\"({x},{y},0.2)\" xspan=\"0.4\" yspan=\"0.4\" zspan=\"0.4\"/>"
        )
    };
    let blocks = [
        block("A", 0.0, -2.7),
        block("B", 0.9, -3.0),
        block("C", -0.9, -3.0),
    ];
    let table = "xmlns=\"http://synapse.cs.umd.edu/tabletop-xml\" xspan=\"20\" yspan=\"12\"";
    fs::write(
        &setup,
        format!("<tabletop {table}>{}</tabletop>", blocks.concat()),
    )
    .unwrap();
    let reach = |x: f32, y: f32, z: f32| {
        format!("Robot(ReachTo(arm: So101, at: ({x}, {y}, {z}))), Robot(WaitUntilStill(10)),")
    };
    let put = |id: &str, x: f32, top: f32| {
        [
            reach(x, -3.0, 1.2),
            reach(x, -3.0, 0.26),
            "Robot(Close(So101)), Robot(WaitUntilStill(5)),".to_owned(),
            format!("Expect(Robot(Holds(arm: So101, object: \"{id}\"))),"),
            reach(x, -3.0, 1.6),
            reach(0.0, -2.7, 1.6),
            reach(0.0, -2.7, top),
            "Robot(Open(So101)), Robot(WaitUntilStill(5)),".to_owned(),
            reach(0.0, -2.7, 1.7),
        ]
        .concat()
    };
    let steps = format!(
        "Load(file: \"so101_blocks.xml\"), Robot(Show), WaitUntilRest(3), {} {} WaitUntilRest(5),\
         Expect(OnTopOf(object: \"B\", of: \"A\")), Expect(OnTopOf(object: \"C\", of: \"B\")),",
        put("B", 0.9, 0.66),
        put("C", -0.9, 1.06)
    );
    robot_after(
        "so101_tower.ron",
        &steps,
        &["--robot", "assets/so101/robot.ron"],
    );
}

/// What `imitate` and `run` refuse, `check` does not call a robot.
#[test]
fn numbers_without_bounds_are_refused_by_check_and_imitate() {
    let demo = crate::support::record_shipped("red_on_blue", "robot_bounds_demo");
    let folder = place("robot_bounds");
    fs::create_dir_all(&folder).unwrap();
    let read = |file: &str| fs::read_to_string(shipped("assets/panda", file)).unwrap();
    let [urdf, layout] = ["panda.urdf", "robot.ron"].map(|file| (folder.join(file), read(file)));
    let arm = layout.0.to_str().unwrap();
    let finger = layout.1.find("finger: (").unwrap();
    let finger = &layout.1[finger..][..layout.1[finger..].find(')').unwrap() + 1];
    let origin = "xyz=\"-0.04 0 -0.45\"";
    assert!(urdf.1.contains(origin), "{}", urdf.1);
    for (file, from, to, words) in [
        (&layout, finger, "finger: (1e30, 1e30, 1e30)", "finger"),
        (&layout, finger, "finger: (101, 1, 1)", "finger"),
        (&layout, "opening: (0, 0.8)", "opening: (0, 1e30)", "limits"),
        (&layout, "height: 0", "height: 1e30", "base or camera"),
        (&layout, "at: (0, 0, 0.1034)", "at: (0, 0, 1e30)", "axes"),
        (&layout, "(0, 0, -1),", "(0, 0, 0),", "axes"),
        (
            &layout,
            "home: -2.4",
            "home: -2.4, limits: (-1e30, 1e30)",
            "limits",
        ),
        (&layout, "home: -2.4", "home: -2.4, speed: 1e30", "speed"),
        (&urdf, origin, "xyz=\"0 0 1e30\"", "over 1000 m away"),
    ] {
        for (path, text) in [&urdf, &layout] {
            fs::write(path, text).unwrap();
        }
        assert!(file.1.contains(from), "{from}");
        fs::write(&file.0, file.1.replacen(from, to, 1)).unwrap();
        for arguments in [
            &["robot", "check", "--robot", arm][..],
            &["imitate", &demo, "--robot", arm],
        ] {
            let output = tabletop(arguments);
            let said = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{arguments:?} {to}: {said}");
            assert!(said.contains(words), "{arguments:?} {to}: {said}");
        }
    }
}
