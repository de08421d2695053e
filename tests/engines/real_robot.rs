//! A Baxter on the genuine ROS 1 in the place of the simulated one.

#[path = "../../crates/robot/tabletop_bridge/tests/ros1/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod rospy;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use rospy::MockBaxter;
use tabletop::{
    core::{JointId, JointName, JointRole, MeasuredJoint, RobotLayout, TICK_SECONDS},
    prelude::*,
    recorder::read_picture,
    storage::InnerFile,
};
use tabletop_harness::test_with;

use crate::support::{
    files, place, record_shipped, replays_to_the_same_bytes, shipped, stderr, stdout, tabletop,
};

/// A Baxter whose arms are where those of the simulated one are at first.
fn baxter() -> MockBaxter {
    let joints = RobotLayout::baxter().joints.iter();
    let home = joints.map(|joint| (joint.urdf_name.clone(), joint.home));
    MockBaxter::start_at(&home.collect())
}

/// The angles of both arms in a recording, in rad, tick by tick.
fn path(recording: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(recording.join("joints.csv")).unwrap();
    let mut angles = BTreeMap::new();
    let mut path = Vec::new();
    let mut now = None;
    for line in text.lines().skip(1) {
        let mut fields = line.split(',');
        let [tick, joint, position] = [(); 3].map(|()| fields.next().unwrap());
        if now.is_some_and(|now| now != tick) {
            path.push(angles.values().copied().collect());
        }
        now = Some(tick);
        if !joint.contains("gripper") && !joint.contains("head") {
            angles.insert(joint.to_owned(), position.parse().unwrap());
        }
    }
    path
}

/// The angles with which a recording begins, in rad, by the joints' names.
fn beginning(recording: &Path) -> BTreeMap<String, f64> {
    let text = fs::read_to_string(recording.join("joints.csv")).unwrap();
    let rows = text.lines().skip(1).map(|line| line.split(','));
    let rows = rows.map(|mut fields| [(); 3].map(|()| fields.next().unwrap()));
    let mut angles = BTreeMap::new();
    for [_, joint, position] in rows {
        angles
            .entry(joint.to_owned())
            .or_insert_with(|| position.parse().unwrap());
    }
    angles
}

/// The largest difference of any joint, in rad.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test_with(Octave, Rospy)]
fn the_example_pair_moves_a_real_robot_along_the_same_path() {
    /// In rad/s, as exampleInit.m says.
    const SPEED: f64 = 0.5;
    // As long as nothing is in the way, of which a real arm keeps clear: on a table that is too small to be.
    let scene = place("real_pair.xml");
    let text =
        "<tabletop xmlns=\"http://synapse.cs.umd.edu/tabletop-xml\" xspan=\"1\" yspan=\"1\"/>";
    fs::write(&scene, text).unwrap();
    let pair = place("real_pair.ron");
    let text = "(setup: \"real_pair.xml\", steps: [Start, Wait(2.0)])";
    fs::write(&pair, text).unwrap();
    let record = |name: &str, options: &[&str]| {
        let folder = place(name);
        let to = folder.to_str().unwrap();
        let all = [
            "run",
            pair.to_str().unwrap(),
            "--script",
            "octave:matlab",
            "--record",
            to,
        ];
        let output = tabletop(&[&all[..], options].concat());
        let said = format!("{}{}", stdout(&output), stderr(&output));
        assert_eq!(output.status.code(), Some(0), "{said}");
        folder
    };
    let recording = record("real_pair_simulated", &["--show-robot"]);
    let simulated = path(&recording);
    // Somebody has brought the arms to where the pair begins: the straight way there leads too near to the trunk.
    let mut baxter = MockBaxter::start_at(&beginning(&recording));
    let address = baxter.address().to_string();
    let options = [
        "--real",
        &address,
        "--yes",
        "--allow-moves",
        "--calibrate-grippers",
        "--speed",
        "0.5",
    ];
    let real = path(&record("real_pair_real", &options));
    assert_eq!(baxter.report().dropped, 0);
    let begun = real
        .iter()
        .position(|at| distance(at, &simulated[0]) < 0.03);
    let under_way = &real[begun.unwrap()..];
    let nearest = |at: &Vec<f64>| {
        let all = simulated.iter().map(|own| distance(at, own));
        all.fold(f64::INFINITY, f64::min)
    };
    let farthest = under_way.iter().map(nearest).fold(0.0, f64::max);
    assert!(
        farthest < SPEED * f64::from(TICK_SECONDS) + 1e-6,
        "{farthest}"
    );
    let way = distance(&under_way[0], under_way.last().unwrap());
    assert!(way > 0.5, "{way}");
}

#[test_with(Rospy)]
fn a_real_robot_imitates_with_objects_at_the_places_of_a_task_file() {
    let demo = record_shipped("red_on_blue", "real_imitate");
    let mut baxter = baxter();
    baxter.order("fill");
    let address = baxter.address().to_string();
    let setup = shipped("tablesetup", "seven-blocks.xml");
    let recorded = place("real_imitated");
    let arguments = ["imitate", &demo, "--real", &address, "--yes"];
    let refused = tabletop(&arguments);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("--setup"), "{}", stderr(&refused));

    let with = ["--setup", setup.to_str().unwrap(), "--calibrate-grippers"];
    let record = ["--record", recorded.to_str().unwrap()];
    let output = tabletop(&[&arguments[..], &with, &record].concat());
    let said = format!("{}{}", stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("Done: 1 step"), "{said}");
    assert_eq!(baxter.report().dropped, 0);
    let states = fs::read_to_string(recorded.join("states.csv")).unwrap();
    let last = |id: &str| {
        let mut rows = states.lines().map(|row| row.split(',').collect::<Vec<_>>());
        let row = rows.rfind(|row| row[1] == id).unwrap();
        [2, 3, 4].map(|field| row[field].parse::<f32>().unwrap())
    };
    let [red, blue] = ["One", "Two"].map(last);
    assert!((red[2] - 1.5).abs() < 0.01, "{red:?}");
    assert!(
        (red[0] - blue[0]).hypot(red[1] - blue[1]) < 0.1,
        "{red:?} {blue:?}"
    );
    let session = fs::read_to_string(recorded.join("session.jsonl")).unwrap();
    assert!(session.contains(&format!("\"real\":\"{address}\"")));
}

#[test_with(Rospy)]
fn a_robot_with_an_empty_hand_has_not_done_it() {
    let demo = record_shipped("red_on_blue", "real_empty_demo");
    let mut baxter = baxter();
    let address = baxter.address().to_string();
    let setup = shipped("tablesetup", "seven-blocks.xml");
    let output = tabletop(&[
        "imitate",
        &demo,
        "--real",
        &address,
        "--yes",
        "--setup",
        setup.to_str().unwrap(),
        "--calibrate-grippers",
    ]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let said = stdout(&output);
    let reason = said.contains("the gripper of limb right holds nothing, where One was to be")
        || said.contains("the gripper of limb left holds nothing, where One was to be");
    assert!(said.contains("Step 1 failed") && reason, "{said}");
    assert_eq!(baxter.report().dropped, 0);
}

#[test_with(Rospy)]
fn an_order_to_a_gripper_that_is_not_calibrated_names_the_option() {
    let scenario = place("real_gripper.ron");
    fs::write(&scenario, "(steps: [Robot(Close(Left)), Wait(4)])").unwrap();
    let mut baxter = baxter();
    let address = baxter.address().to_string();
    let arguments = [
        "run",
        scenario.to_str().unwrap(),
        "--real",
        &address,
        "--yes",
    ];
    let refused = tabletop(&arguments);
    assert_eq!(refused.status.code(), Some(1));
    let said = stderr(&refused);
    assert!(said.contains("gripper of limb left"), "{said}");
    assert!(said.contains("--calibrate-grippers"), "{said}");
    let output = tabletop(&[&arguments[..], &["--calibrate-grippers"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(baxter.report().openings[0] < 1.0);
}

/// Writes all that it is sent, a line of JSON for each call.
const LISTENER: &str = r#"
import json
import math

def plain(value):
    if hasattr(value, "shape"):
        return [float(part) for part in value[0, 0]] if len(value.shape) == 3 else plain(value.tolist())
    if hasattr(value, "__dict__"):
        return {name: plain(part) for name, part in vars(value).items()}
    if isinstance(value, dict):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value

def init(aux):
    pass

# What is not named in the code is not sent.
ASKED = ["objects", "contacts", "held", "controls", "trackerLoc", "seen", "task", "jointTorques"]

def callback(sensor, motor, aux):
    with open("FILE", "a") as file:
        print(json.dumps(plain(sensor)), file=file)
"#;

/// What the simulated robot would be where the real one is, by the model alone: its end effectors and trackers.
fn model(angles: &BTreeMap<String, f64>) -> Robot {
    let mut app = headless_app();
    let joints = RobotLayout::baxter().joints.iter();
    let measured = joints.filter_map(|joint| {
        let position = *angles.get(&joint.urdf_name)?;
        let measured = MeasuredJoint {
            position,
            ..MeasuredJoint::default()
        };
        Some((joint.name, measured))
    });
    let mirror = RobotCommand::Mirror(measured.collect());
    app.world_mut()
        .write_command(SceneCommand::Set(Box::default()));
    app.world_mut().write_command(mirror);
    app.step(1);
    app.world().resource::<Robot>().clone()
}

#[test_with(Python, Rospy)]
fn a_script_and_a_recording_get_nothing_of_the_simulated_robot() {
    let mut angles: BTreeMap<_, _> = RobotLayout::baxter()
        .joints
        .iter()
        .map(|joint| (joint.urdf_name.clone(), joint.home))
        .collect();
    // Where the simulated arm would stop at the table.
    for (joint, angle) in [("left_s1", 0.9), ("left_e1", 0.0), ("left_w1", 0.0)] {
        angles.insert(joint.to_owned(), angle);
    }
    let baxter = MockBaxter::start_at(&angles);
    angles.insert("head_pan".into(), 0.0);
    let address = baxter.address().to_string();
    // Scripts beside it would ask for more.
    let folder = place("real_listener");
    fs::create_dir(&folder).unwrap();
    let (script, heard) = (folder.join("listener.py"), folder.join("heard.jsonl"));
    fs::write(&script, LISTENER.replace("FILE", heard.to_str().unwrap())).unwrap();
    let recording = place("real_listened");
    let output = tabletop(&[
        "run",
        "--shadow",
        &address,
        "--seconds",
        "4",
        "--script",
        &format!("python:{}", script.display()),
        "--record",
        recording.to_str().unwrap(),
    ]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        !said.contains("in the way") && !said.contains("stops"),
        "{said}"
    );

    // Every field of every call is what was measured, or follows from that by the model of the robot.
    let model = model(&angles);
    let layout = RobotLayout::baxter();
    let measured = |joint: &JointId| angles[&layout.joint(*joint).urdf_name];
    let each = |of: &dyn Fn(&JointId) -> f64| -> Vec<Vec<f64>> {
        let limbs = layout.limbs.iter();
        limbs
            .map(|limb| limb.joints.iter().map(of).collect())
            .collect()
    };
    let places: Vec<_> = model
        .limbs
        .iter()
        .map(|limb| limb.end_effector.location.to_array().map(f64::from))
        .collect();
    let calls = fs::read_to_string(&heard).unwrap();
    let calls: Vec<serde_json::Value> = calls
        .lines()
        .map(|call| serde_json::from_str(call).unwrap())
        .collect();
    let mut pictures = 0;
    assert!(calls.len() > 200, "{}", calls.len());
    for call in &calls {
        for (field, sent) in call.as_object().unwrap() {
            match field.as_str() {
                "timeElapsed" => {
                    assert!((sent.as_f64().unwrap() - f64::from(TICK_SECONDS)).abs() < 1e-9)
                }
                "demoCue" => assert_eq!(*sent, serde_json::json!(true)),
                "jointAngles" => assert_eq!(*sent, serde_json::json!(each(&measured))),
                "jointTorques" => assert_eq!(*sent, serde_json::json!(each(&|_| 0.5))),
                "gripperOpening" => assert_eq!(*sent, serde_json::json!([[2.0, 2.0]])),
                "headAngle" => assert_eq!(*sent, serde_json::json!(0.0)),
                "endEffPos" => assert_eq!(*sent, serde_json::json!(places)),
                "trackerLoc" => {
                    let elbow = model.limbs[0].joint_origins[1].to_array().map(f64::from);
                    assert_eq!(sent["l-E1"], serde_json::json!(elbow));
                }
                "held" => assert_eq!(*sent, serde_json::json!({"left": [], "right": []})),
                // Its picture is of one colour, in which nothing can be seen.
                "seen" => assert_eq!(sent["sure"], serde_json::json!([[0.0, 0.0]])),
                "rgbVision" => {
                    pictures += 1;
                    assert_eq!(
                        *sent,
                        serde_json::json!([30.0 / 255.0, 20.0 / 255.0, 10.0 / 255.0])
                    );
                }
                other => panic!("{other} is not of the real robot: {sent}"),
            }
        }
    }
    assert!(pictures > 5, "{pictures}");

    let rows = fs::read_to_string(recording.join("joints.csv")).unwrap();
    let mut joints = BTreeSet::new();
    for row in rows.lines().skip(1) {
        let fields: Vec<_> = row.split(',').collect();
        let joint = layout
            .find_joint(JointName::new(fields[1]).unwrap())
            .unwrap();
        let numbers = [2, 3, 4].map(|field| fields[field].parse::<f64>().unwrap());
        let expected = match layout.joint(joint).role {
            JointRole::Limb { .. } => [measured(&joint), 0.0, 0.5],
            JointRole::Neck => [0.0; 3],
            JointRole::Gripper(_) => [2.0, 0.0, 0.0],
        };
        assert_eq!(numbers, expected, "{row}");
        joints.insert(joint);
    }
    assert_eq!(joints.len(), layout.joints.len());
    let files = files(&recording);
    let recorded = files.keys().filter(|name| name.ends_with(".png"));
    let recorded: Vec<_> = recorded
        .map(|name| read_picture(&InnerFile::at(&recording.join(name)).unwrap()).unwrap())
        .collect();
    assert!(recorded.len() > 5, "{}", recorded.len());
    for picture in recorded {
        assert!(picture.rgb.chunks(3).all(|pixel| pixel == [30, 20, 10]));
    }
    // A replay goes through the same states, and draws its own pictures.
    replays_to_the_same_bytes(&recording);
}
