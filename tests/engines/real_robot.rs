//! A Baxter on the genuine ROS 1 in the place of the simulated one.

#[path = "../../crates/tabletop_bridge/tests/ros1/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod rospy;

use std::{collections::BTreeMap, fs, path::Path};

use rospy::MockBaxter;
use tabletop::core::{RobotLayout, TICK_SECONDS};
use tabletop_harness::test_with;

use crate::support::{place, record_shipped, shipped, stderr, stdout, tabletop};

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
        path(&folder)
    };
    let simulated = record("real_pair_simulated", &["--show-robot"]);
    let mut baxter = baxter();
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
    let real = record("real_pair_real", &options);
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
    assert!(said.contains("Done: 1 steps"), "{said}");
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
