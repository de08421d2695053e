//! Inverse kinematics: reached, within limits, always the same, smooth, and honest where nothing reaches.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::array::from_fn;

use glam::{DAffine3, DQuat, DVec3};
use proptest::prelude::*;
use tabletop_kinematics::{ArmChain, RobotModel, Target, baxter};

const ARM_JOINTS: usize = 7;

const START: [f64; ARM_JOINTS] = [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0];

fn left_arm() -> ArmChain {
    ArmChain::between(&baxter().unwrap(), "torso", "left_end_effector").unwrap()
}

/// Random numbers from 0 to 1 that are the same everywhere.
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

fn random_angles(arm: &ArmChain, state: &mut u64) -> Vec<f64> {
    let limits = arm.limits().iter();
    limits
        .map(|[least, largest]| least + random(state) * (largest - least))
        .collect()
}

fn assert_solves(arm: &ArmChain, target: &Target, angles: &[f64]) {
    let miss = arm.miss(target, angles);
    assert!(miss.position < 1e-4, "{} m", miss.position);
    assert!(
        miss.rotation < 0.1_f64.to_radians(),
        "{} rad",
        miss.rotation
    );
    assert_eq!(arm.clamp(angles), *angles, "within the limits");
}

#[test]
fn a_thousand_poses_that_can_be_reached_are_reached() {
    let robot = baxter().unwrap();
    let mut state = 1;
    for side in ["left", "right"] {
        let arm = ArmChain::between(&robot, "torso", &format!("{side}_end_effector")).unwrap();
        for i in 0..1000 {
            let pose = arm.tip(&random_angles(&arm, &mut state));
            let target = Target::Pose(pose);
            match arm.solve(&target, &START) {
                Ok(angles) => assert_solves(&arm, &target, &angles),
                Err(error) => panic!("{side} {i}: {error}"),
            }
        }
    }
}

#[test]
fn the_same_question_has_the_same_answer() {
    let arm = left_arm();
    let mut state = 7;
    for _ in 0..50 {
        let target = Target::Pose(arm.tip(&random_angles(&arm, &mut state)));
        assert_eq!(
            arm.solve(&target, &START).unwrap(),
            arm.solve(&target, &START).unwrap()
        );
    }
}

#[test]
fn where_the_hand_is_already_nothing_moves() {
    let arm = left_arm();
    assert_eq!(
        arm.solve(&Target::Pose(arm.tip(&START)), &START).unwrap(),
        START
    );
}

#[test]
fn small_steps_of_the_hand_are_small_steps_of_the_joints() {
    let arm = left_arm();
    let start = arm.tip(&START);
    let mut angles = START.to_vec();
    // A circle of 20 cm in front of the robot in steps of 2.5 mm.
    for i in 0..=250 {
        let turn = f64::from(i) * std::f64::consts::TAU / 250.0;
        let mut pose = start;
        pose.translation += 0.1 * DVec3::new(1.0 - turn.cos(), turn.sin(), 0.0)
            + DVec3::new(0.15, 0.0, 0.1) * f64::from(i.min(50)) / 50.0;
        let target = Target::Pose(pose);
        let next = arm.solve(&target, &angles).unwrap();
        assert_solves(&arm, &target, &next);
        let step = (0..ARM_JOINTS)
            .map(|i| (next[i] - angles[i]).abs())
            .fold(0.0, f64::max);
        assert!(step < 0.05, "step {i}: {step} rad");
        angles = next;
    }
}

#[test]
fn a_point_is_reached_with_any_rotation() {
    let arm = left_arm();
    let mut state = 3;
    for _ in 0..200 {
        let point = arm.tip(&random_angles(&arm, &mut state)).translation;
        let target = Target::Point(point);
        let angles = arm.solve(&target, &START).unwrap();
        assert_solves(&arm, &target, &angles);
    }
}

#[test]
fn an_unreachable_target_is_reported_with_the_nearest_posture() {
    let arm = left_arm();
    let far = Target::Point(DVec3::new(3.0, 1.0, 0.4));
    let error = arm.solve(&far, &START).unwrap_err();
    assert_eq!(arm.miss(&far, &error.best), error.miss);
    // The shoulder is 1.17 m of arm and gripper away from the hand at best.
    assert!((1.5..2.1).contains(&error.miss.position), "{error}");
    assert!(error.to_string().starts_with("unreachable: "), "{error}");
}

#[test]
fn hostile_targets_are_unreachable_and_nothing_else() {
    let arm = left_arm();
    for target in [
        Target::Point(DVec3::NAN),
        Target::Point(DVec3::splat(f64::INFINITY)),
        Target::Point(DVec3::splat(1e300)),
        Target::Pose(DAffine3::from_mat3(glam::DMat3::ZERO)),
        Target::Pose(DAffine3::from_translation(DVec3::NAN)),
    ] {
        let error = arm.solve(&target, &[f64::NAN; ARM_JOINTS]).unwrap_err();
        assert!(
            error.best.iter().all(|angle| angle.is_finite()),
            "{target:?}: {error:?}"
        );
    }
}

#[test]
fn narrower_limits_are_kept() {
    let arm = left_arm();
    let mut limits = arm.limits().to_vec();
    limits[2] = [-1.6, -1.4];
    let arm = arm.with_limits(limits);
    let mut state = 11;
    for _ in 0..100 {
        let target = Target::Pose(arm.tip(&random_angles(&arm, &mut state)));
        assert_solves(&arm, &target, &arm.solve(&target, &START).unwrap());
    }
}

/// A lift with three joints that turn and a wrist on it.
const LIFT: &str = r#"<robot name="lift">
    <link name="0"/> <link name="1"/> <link name="2"/> <link name="3"/> <link name="4"/> <link name="5"/> <link name="6"/> <link name="7"/>
    <joint name="lift" type="prismatic"><parent link="0"/><child link="1"/><origin xyz="0.1 0 0.4" rpy="0 0.2 0"/>
        <axis xyz="0 0 1"/><limit lower="0" upper="0.4" velocity="1"/></joint>
    <joint name="a" type="revolute"><parent link="1"/><child link="2"/><origin xyz="0 0 0.2"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1"/></joint>
    <joint name="b" type="revolute"><parent link="2"/><child link="3"/><origin xyz="0.1 0 0"/>
        <axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" velocity="1"/></joint>
    <joint name="c" type="revolute"><parent link="3"/><child link="4"/><origin xyz="0.4 0 0"/>
        <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1"/></joint>
    <joint name="d" type="continuous"><parent link="4"/><child link="5"/><origin xyz="0.3 0 0"/><axis xyz="1 0 0"/></joint>
    <joint name="e" type="revolute"><parent link="5"/><child link="6"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1"/></joint>
    <joint name="f" type="continuous"><parent link="6"/><child link="7"/><axis xyz="1 0 0"/><origin xyz="0.1 0 0"/></joint>
</robot>"#;

fn lift() -> ArmChain {
    let robot = RobotModel::from_urdf(LIFT).unwrap();
    let arm = ArmChain::between(&robot, "0", "7").unwrap();
    let limits: Vec<_> = arm
        .limits()
        .iter()
        .map(|limits| limits.map(|limit| limit.clamp(-6.0, 6.0)))
        .collect();
    arm.with_limits(limits)
}

#[test]
fn an_arm_on_a_lift_reaches_what_it_can() {
    let arm = lift();
    let mut state = 5;
    let mut high = 0;
    for i in 0..300 {
        let angles = random_angles(&arm, &mut state);
        let target = Target::Pose(arm.tip(&angles));
        match arm.solve(&target, &[0.2, 0.0, 0.3, 0.3, 0.0, 0.3, 0.0]) {
            Ok(found) => {
                assert_solves(&arm, &target, &found);
                high += usize::from(found[0] > 0.25);
            }
            Err(error) => panic!("{i}: {error}"),
        }
    }
    assert!(high > 50, "the lift is used: {high}");
}

#[test]
fn an_arm_on_a_lift_has_the_frames_of_its_model() {
    let robot = RobotModel::from_urdf(LIFT).unwrap();
    let arm = lift();
    let angles = random_angles(&arm, &mut 9);
    let mut values = robot.zero();
    arm.set_angles(&angles, &mut values);
    let frames = robot.frames(&values);
    let tip = robot.find_link("7").unwrap();
    assert!(arm.tip(&angles).abs_diff_eq(frames[tip], 1e-12));
    let ours = arm.jacobian(&angles);
    let theirs = robot.jacobian(&frames, tip, DVec3::ZERO);
    for (joint, twist) in arm.joints().iter().zip(ours) {
        let other = theirs[joint.index()];
        assert!(twist.linear.distance(other.linear) < 1e-12, "{twist:?}");
        assert!(twist.angular.distance(other.angular) < 1e-12, "{twist:?}");
    }
}

/// Two links that turn about verticals, a quill, and a wrist.
const SCARA: &str = r#"<robot name="scara">
    <link name="0"/> <link name="1"/> <link name="2"/> <link name="3"/> <link name="4"/>
    <joint name="a" type="revolute"><parent link="0"/><child link="1"/><origin xyz="0 0 0.4"/>
        <axis xyz="0 0 1"/><limit lower="-2.4" upper="2.4" velocity="1"/></joint>
    <joint name="b" type="revolute"><parent link="1"/><child link="2"/><origin xyz="0.3 0 0"/>
        <axis xyz="0 0 1"/><limit lower="-2.4" upper="2.4" velocity="1"/></joint>
    <joint name="c" type="prismatic"><parent link="2"/><child link="3"/><origin xyz="0.3 0 0"/>
        <axis xyz="0 0 -1"/><limit lower="0" upper="0.3" velocity="1"/></joint>
    <joint name="d" type="revolute"><parent link="3"/><child link="4"/>
        <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
</robot>"#;

#[test]
fn a_scara_reaches_poses_of_seven_digits() {
    let robot = RobotModel::from_urdf(SCARA).unwrap();
    let arm = ArmChain::between(&robot, "0", "4").unwrap();
    let mut state = 21;
    for i in 0..200 {
        let pose = arm.tip(&random_angles(&arm, &mut state));
        let rotation = DQuat::from_mat3(&pose.matrix3).as_quat().as_dquat();
        let location = pose.translation.as_vec3().as_dvec3();
        let rounded = DAffine3::from_rotation_translation(rotation.normalize(), location);
        let target = Target::Pose(rounded);
        match arm.solve(&target, &[0.1, 0.5, 0.1, 0.0]) {
            Ok(angles) => assert_solves(&arm, &target, &angles),
            Err(error) => panic!("{i}: {error}"),
        }
        let leaning = rounded * DAffine3::from_rotation_x(0.01);
        assert!(
            arm.solve_from(&Target::Pose(leaning), &[0.0; 4], 1)
                .is_err()
        );
        let tilted = rounded * DAffine3::from_rotation_x(4e-6);
        assert!(arm.solve(&Target::Pose(tilted), &[0.0; 4]).is_ok());
    }
}

proptest! {
    #[test]
    fn the_jacobian_is_the_derivative_of_the_tip(
        shares in prop::array::uniform7(0.0..1.0_f64),
        joint in 0..ARM_JOINTS,
    ) {
        const STEP: f64 = 1e-6;
        let arm = left_arm();
        let angles: [f64; ARM_JOINTS] = from_fn(|i| {
            let [least, largest] = arm.limits()[i];
            least + shares[i] * (largest - least)
        });
        let moved = |by: f64| {
            let mut moved = angles;
            moved[joint] += by;
            arm.tip(&moved)
        };
        let (before, after) = (moved(-STEP), moved(STEP));
        let twist = arm.jacobian(&angles)[joint];
        let linear = (after.translation - before.translation) / (2.0 * STEP);
        prop_assert!(linear.distance(twist.linear) < 1e-8);
        let turn = DQuat::from_mat3(&(after.matrix3 * before.matrix3.transpose()));
        let angular = turn.to_scaled_axis() / (2.0 * STEP);
        prop_assert!(angular.distance(twist.angular) < 1e-8);
    }
}
