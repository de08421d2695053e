//! Forward kinematics against numbers that independent libraries computed from the manufacturer's description.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use glam::{DAffine3, DQuat, DVec3};
use serde_json::Value;
use tabletop_kinematics::{ArmChain, baxter};

const TOLERANCE: f64 = 1e-6;

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The link that the file calls by its joint.
fn link_name(side: &str, frame: &str) -> String {
    let name = match frame {
        "s1" => "lower_shoulder",
        "e1" => "lower_elbow",
        "w1" => "lower_forearm",
        "w2" => "wrist",
        other => other,
    };
    match side {
        "head" => name.to_owned(),
        side => format!("{side}_{name}"),
    }
}

fn assert_near(frame: &DAffine3, expected: &Value, what: &str) {
    let position = DVec3::from_slice(&numbers(&expected["position"]));
    let rotation = DQuat::from_slice(&numbers(&expected["quaternion_xyzw"])).normalize();
    let distance = frame.translation.distance(position);
    let angle = DQuat::from_mat3(&frame.matrix3).dot(rotation).abs();
    // The angle between two rotations is twice that between their quaternions.
    let angle = 2.0 * (1.0 - angle * angle).max(0.0).sqrt();
    assert!(distance < TOLERANCE, "{what}: {distance} m");
    // A square root of the rounding of a dot product near 1.
    assert!(angle < TOLERANCE, "{what}: {angle} rad");
}

#[test]
fn every_vector_of_the_file_is_met() {
    let file: Value = serde_json::from_str(include_str!("data/baxter_fk_vectors.json")).unwrap();
    let robot = baxter().unwrap();
    let mut checked = 0;
    for vector in file["vectors"].as_array().unwrap() {
        let mut configuration = robot.zero();
        for side in ["left", "right"] {
            let tip = format!("{side}_end_effector");
            let arm = ArmChain::between(&robot, "base", &tip).unwrap();
            let angles = numbers(&vector[format!("q_{side}")]);
            arm.set_angles(&angles, &mut configuration);
        }
        let pan = robot.find_joint("head_pan").unwrap();
        configuration[pan] = vector["head_pan"].as_f64().unwrap();
        let frames = robot.frames(&configuration);
        for side in ["left", "right", "head"] {
            for (name, expected) in vector[side].as_object().unwrap() {
                let link = link_name(side, name);
                let what = format!("{}: {link}", vector["name"]);
                assert_near(&frames[robot.find_link(&link).unwrap()], expected, &what);
                checked += 1;
            }
        }
    }
    assert_eq!(checked, 16 * (7 + 7 + 3));
}
