//! `tabletop robot`, as another program talks to it.

use std::{io::Write as _, path::Path, process::Stdio};

use serde_json::{Value, json};

use crate::support::command;

struct Answers {
    lines: Vec<Value>,
    code: i32,
    stderr: String,
}

/// Runs `tabletop robot` with these lines on its standard input.
fn robot(arguments: &[&str], input: &[u8]) -> Answers {
    let mut program = command(&[&["robot"], arguments].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that stops at once does not read.
    let _ = program.stdin.take().unwrap().write_all(input);
    let output = program.wait_with_output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    Answers {
        lines: stdout
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect(),
        code: output.status.code().unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

fn assert_near(found: &Value, expected: &[f64], tolerance: f64) {
    let found = numbers(found);
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() < tolerance,
            "{found:?} instead of {expected:?}"
        );
    }
}

#[test]
fn fk_gives_every_frame_in_the_torsos_and_the_tables_frame() {
    let straight = [0.0; 7];
    let posture = json!({ "left": straight, "right": straight, "head_pan": 0.5 });
    let answers = robot(&["fk"], format!("{{}}\n\n{posture}").as_bytes());
    assert_eq!(
        (answers.lines.len(), answers.code),
        (2, 0),
        "{}",
        answers.stderr
    );
    let [start, zero] = [0, 1].map(|i| &answers.lines[i]);

    assert_near(
        &start["table"]["left_end_effector"]["position"],
        &[-2.078, -5.859, 2.688],
        1e-3,
    );
    assert_near(
        &start["table"]["right_end_effector"]["position"],
        &[2.078, -5.859, 2.688],
        1e-3,
    );
    assert_near(
        &zero["torso"]["left_gripper_base"]["position"],
        &[0.81514, 1.01014, 0.32098],
        1e-5,
    );
    let rotation = [-0.27060, 0.65328, 0.27060, 0.65328];
    assert_near(
        &zero["torso"]["left_gripper_base"]["quaternion_xyzw"],
        &rotation,
        1e-5,
    );
    assert_near(
        &zero["table"]["torso"]["position"],
        &[0.0, -9.0, 2.0],
        1e-12,
    );
    let half = 0.5_f64.sqrt();
    assert_near(
        &zero["table"]["torso"]["quaternion_xyzw"],
        &[0.0, 0.0, half, half],
        1e-12,
    );
    assert_near(
        &zero["torso"]["head"]["quaternion_xyzw"],
        &[0.0, 0.0, 0.247404, 0.968912],
        1e-6,
    );

    // The grippers are open: 2 units between the fingers, each 0.3 thick.
    let finger = |name: &str| numbers(&start["table"][name]["position"]);
    let (left, right) = (finger("l_gripper_l_finger"), finger("l_gripper_r_finger"));
    let distance: f64 = left.iter().zip(&right).map(|(a, b)| (a - b).powi(2)).sum();
    assert!((distance.sqrt() - 2.3).abs() < 1e-9, "{left:?} {right:?}");
}

#[test]
fn ik_undoes_fk_in_both_frames() {
    let left = [0.1, -0.4, -0.8, 1.4, 0.6, 1.1, -0.3];
    let posture = json!({ "left": left }).to_string();
    let frames = &robot(&["fk"], posture.as_bytes()).lines[0];
    let mut questions = String::new();
    for frame in ["table", "torso"] {
        for link in ["left_end_effector", "left_gripper", "left_hand_camera"] {
            let mut question = frames[frame][link].clone();
            question["arm"] = json!("left");
            question["frame"] = json!(frame);
            question["link"] = json!(link);
            questions += &format!("{question}\n");
        }
    }
    let answers = robot(&["ik"], questions.as_bytes());
    assert_eq!(
        (answers.lines.len(), answers.code),
        (6, 0),
        "{:?}",
        answers.lines
    );
    for (answer, line) in answers.lines.iter().zip(questions.lines()) {
        assert!(answer["position_error"].as_f64().unwrap() < 1e-4);
        assert!(answer["rotation_error"].as_f64().unwrap() < 1e-3);
        let question: Value = serde_json::from_str(line).unwrap();
        let posture = json!({ "left": answer["angles"] }).to_string();
        let again = &robot(&["fk"], posture.as_bytes()).lines[0];
        let [frame, link] = ["frame", "link"].map(|key| question[key].as_str().unwrap());
        let found = &again[frame][link]["position"];
        assert_near(found, &numbers(&question["position"]), 1e-3);
    }
}

#[test]
fn ik_takes_points_of_the_table_and_stays_near_its_seed() {
    let home = [-0.25, 0.0, 1.527, 2.618, -1.529, 1.5, 0.0];
    let point = json!({ "arm": "right", "position": [2.1, -5.8, 2.7] });
    let seeded = json!({ "arm": "right", "position": [2.1, -5.8, 2.7], "seed": home });
    let answers = robot(&["ik"], format!("{point}\n{seeded}\n").as_bytes());
    assert_eq!(answers.code, 0);
    assert_eq!(
        answers.lines[0], answers.lines[1],
        "home is where the search begins"
    );
    assert_eq!(answers.lines[0]["rotation_error"], 0.0);
    assert_near(&answers.lines[0]["angles"], &home, 0.1);
}

#[test]
fn an_unreachable_target_is_reported_and_ends_in_1() {
    let far = json!({ "arm": "left", "position": [-30.0, 20.0, 5.0] });
    let near = json!({ "arm": "left", "position": [-3.0, 0.0, 3.0] });
    let answers = robot(&["ik"], format!("{far}\n{near}\n").as_bytes());
    assert_eq!(answers.code, 1);
    let error = answers.lines[0]["error"].as_str().unwrap();
    assert!(error.starts_with("unreachable: "), "{error}");
    assert!(
        answers.lines[1]["angles"].is_array(),
        "the others are answered"
    );
}

#[test]
fn wrong_lines_are_reported_by_number_and_end_in_2() {
    let good = json!({ "arm": "left", "position": [-3.0, 0.0, 3.0] }).to_string();
    let cases = [
        (b"{".as_slice(), "line 2: column 1: EOF"),
        (b"[1]", "line 2: "),
        (b"\xff\xfe", "line 2: "),
        (b"{}", "line 2: column 2: missing field `arm`"),
        (
            br#"{"arm":"left","position":[1,2,3],"speed":1}"#,
            "line 2: column 40: unknown field `speed`",
        ),
        (
            br#"{"arm":"third","position":[1,2,3]}"#,
            "line 2: the robot has no limb third, only left, right",
        ),
        (br#"{"arm":"left","position":[1,2]}"#, "line 2: "),
        (br#"{"arm":"left","position":[1,2,1e999]}"#, "line 2: "),
        (
            br#"{"arm":"left","position":[1,2,3],"link":"left_tail"}"#,
            "line 2: robot baxter has no link left_tail",
        ),
        (
            br#"{"arm":"left","position":[1,2,3],"link":"right_hand"}"#,
            "line 2: link right_hand is not on the left arm",
        ),
        (
            br#"{"arm":"left","position":[1,2,3],"link":"head"}"#,
            "line 2: no arm leads from link base to link head",
        ),
        (
            br#"{"arm":"left","position":[1,2,3],"quaternion_xyzw":[0,0,0,0]}"#,
            "line 2: quaternion_xyzw is no rotation",
        ),
    ];
    for (wrong, start) in cases {
        let input = [good.as_bytes(), b"\n", wrong, b"\n", good.as_bytes()].concat();
        let answers = robot(&["ik"], &input);
        assert_eq!((answers.lines.len(), answers.code), (3, 2));
        let error = answers.lines[1]["error"].as_str().unwrap();
        assert!(error.starts_with(start), "{error}");
        assert_eq!(answers.lines[0], answers.lines[2]);
    }
    let answers = robot(&["fk"], b"{\"left\":[0,0,0]}\n{\"head\":0}\n{}\n");
    assert_eq!((answers.lines.len(), answers.code), (3, 2));
    assert!(answers.lines[2]["torso"].is_object());
}

#[test]
fn another_robot_can_be_asked() {
    let smile = robot(&["fk", "--robot", "assets/baxter/baxter_smile.urdf"], b"{}");
    let hand = &smile.lines[0]["table"]["left_end_effector"]["position"];
    assert_near(hand, &[-2.15050, -5.93695, 2.57960], 0.01);

    let missing = robot(&["fk", "--robot", "no_such.urdf"], b"{}");
    assert_eq!(missing.code, 2);
    assert!(
        missing.stderr.contains("no_such.urdf: "),
        "{}",
        missing.stderr
    );

    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("broken.urdf");
    std::fs::write(&path, "<robot name=\"broken\">\n<link/>\n</robot>").unwrap();
    let broken = robot(&["--robot", path.to_str().unwrap(), "ik"], b"");
    assert_eq!((broken.lines.len(), broken.code), (0, 2));
    assert!(
        broken.stderr.contains("broken.urdf: line 2: link: "),
        "{}",
        broken.stderr
    );
}
