//! The report's simulator: its file, and its numbers.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use glam::{DAffine3, DVec3};
use tabletop_kinematics::{ArmChain, RobotModel, baxter, baxter_smile};

/// Units of the table (0.1 m). The numbers were computed with 1.571 for a right angle.
const TOLERANCE: f64 = 0.01;

const START: [f64; 7] = [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0];

fn mirrored(mut angles: [f64; 7]) -> [f64; 7] {
    for joint in [0, 2, 4, 6] {
        angles[joint] *= -1.0;
    }
    angles
}

fn hand(robot: &RobotModel, side: &str, angles: [f64; 7]) -> DAffine3 {
    let tip = format!("{side}_end_effector");
    ArmChain::between(robot, "torso", &tip)
        .unwrap()
        .tip(&angles)
}

/// A point of the torso's frame in the table's, whose depth is 12 units.
fn on_table(point: DVec3) -> DVec3 {
    DVec3::new(-10.0 * point.y, 10.0 * point.x - 9.0, 10.0 * point.z + 2.0)
}

fn direction_on_table(direction: DVec3) -> DVec3 {
    DVec3::new(-direction.y, direction.x, direction.z)
}

#[test]
fn the_files_differ_in_the_mounts_of_the_arms_alone() {
    let built = include_str!("../../../../assets/baxter/baxter.urdf");
    let smile = include_str!("../../../../assets/baxter/baxter_smile.urdf");
    let edited: Vec<String> = built
        .lines()
        .map(|line| {
            line.replace("<robot name=\"baxter\">", "<robot name=\"baxter_smile\">")
                .replace("0.7854\"", "0.7845\"")
                .replace("0.055695 0 0.011038", "0.055695 0.011038 0")
        })
        .collect();
    assert_eq!(smile.lines().collect::<Vec<_>>(), edited);
    let changed = built.lines().zip(smile.lines()).filter(|(a, b)| a != b);
    assert_eq!(changed.count(), 5, "the name, two mounts, two shoulders");
}

#[test]
fn hands_are_where_the_reports_simulator_had_them() {
    let robot = baxter_smile().unwrap();
    let half = |joint: usize| std::array::from_fn(|i| if i == joint { 0.5 } else { 0.0 });
    let bent = [0.3, -0.5, 0.4, 1.2, -0.6, 0.7, 0.9];
    let mut elbow_turned = [0.0; 7];
    elbow_turned[2] = 1.571;
    let cases = [
        ("right", [0.0; 7], [10.41997, -0.36424, 5.09790]),
        ("left", [0.0; 7], [-10.57097, -0.51498, 5.09790]),
        ("right", mirrored(START), [1.99760, -5.78047, 2.57658]),
        ("left", START, [-2.15050, -5.93695, 2.57960]),
        ("right", elbow_turned, [9.86014, 0.19503, 5.88569]),
        ("right", half(0), [5.65618, 2.45794, 5.09790]),
        ("left", half(0), [-13.40170, -5.27368, 5.09790]),
        ("right", half(1), [9.24450, -1.54324, 0.16073]),
        ("left", half(1), [-9.39408, -1.69256, 0.16073]),
        ("right", bent, [4.66784, -0.67004, 1.83555]),
        ("left", bent, [-10.27551, -6.26765, 1.83555]),
    ];
    for (side, angles, expected) in cases {
        let found = on_table(hand(&robot, side, angles).translation);
        let miss = found.distance(DVec3::from_array(expected));
        assert!(
            miss < TOLERANCE,
            "{side} {angles:?}: {found} instead of {expected:?}"
        );
    }
}

#[test]
fn joints_are_where_the_reports_simulator_had_them() {
    let robot = baxter_smile().unwrap();
    let frames = robot.frames(&robot.zero());
    for (link, expected) in [
        ("right_upper_shoulder", [2.51180, -8.28139, 3.18588]),
        ("right_lower_shoulder", [2.99926, -7.79305, 5.88938]),
        ("right_lower_elbow", [5.57417, -5.21448, 5.19885]),
        ("right_lower_forearm", [8.21936, -2.56644, 5.09829]),
    ] {
        let found = on_table(frames[robot.find_link(link).unwrap()].translation);
        assert!(
            found.distance(DVec3::from_array(expected)) < TOLERANCE,
            "{link}: {found}"
        );
    }
}

#[test]
fn the_hands_frame_has_x_along_the_opening_and_z_back_to_the_wrist() {
    let robot = baxter_smile().unwrap();
    let opening = |hand: DAffine3| direction_on_table(hand.matrix3.x_axis);
    let pointing = |hand: DAffine3| direction_on_table(-hand.matrix3.z_axis);

    let straight = hand(&robot, "right", [0.0; 7]);
    assert!(opening(straight).distance(DVec3::new(0.7073, -0.7069, 0.0006)) < 0.003);
    assert!(pointing(straight).distance(DVec3::new(0.7069, 0.7073, 0.0)) < 0.003);

    let down = hand(&robot, "right", mirrored(START));
    assert!(pointing(down).distance(DVec3::new(-0.048, -0.080, -0.996)) < 0.003);
    assert!(opening(down).y.abs() > 0.99);
}

#[test]
fn baxter_as_built_has_its_hands_where_the_slip_is_not() {
    let robot = baxter().unwrap();
    let found = |side, angles| on_table(hand(&robot, side, angles).translation);
    for (found, expected) in [
        (found("left", [0.0; 7]), [-10.503, -0.447, 5.210]),
        (found("left", START), [-2.078, -5.859, 2.688]),
        (found("right", mirrored(START)), [2.078, -5.859, 2.688]),
    ] {
        let miss = found.distance(DVec3::from_array(expected));
        assert!(miss < 0.001, "{found} instead of {expected:?}");
    }
}
