//! Motion of the robot in dynamic mode.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{
    Stage, block,
    motors::{ARM, SECOND, check_limits, drive, go, off},
};
use proptest::prelude::*;
use tabletop_core::{
    Arm, Drive, Hand, HandCommand, HistoryCommand, JOINTS_PER_ARM, Recording, RobotCommand,
    RobotJoint, StepApp, TICK_SECONDS,
};
use tabletop_geometry::Pose;
use tabletop_kinematics::baxter;

const SECONDS: f64 = TICK_SECONDS as f64;

/// Straight out to the side, level, over nothing but the table.
const STRAIGHT: [f64; JOINTS_PER_ARM] = [0.0, -0.25, 0.0, 0.0, 0.0, 0.0, 0.0];

/// The right gripper holds a block of this mass, with its arm stretched out.
fn stretched_with(mass: f32) -> Stage {
    let mut stage = Stage::dynamic();
    stage.reach(ARM, Vec3::new(3.0, -2.0, 0.9), 0.0);
    stage.put(
        "payload",
        block(Vec3::ONE),
        mass,
        Pose::at(Vec3::new(3.0, -2.0, 0.5)),
    );
    stage.app.step(5);
    drive(
        &mut stage,
        &[(RobotJoint::gripper(ARM), Drive::Toward(0.0))],
    );
    stage.app.step(100);
    assert_eq!(stage.robot().limb(ARM).holds.len(), 1);
    stage.reach(ARM, Vec3::new(3.0, -2.0, 4.0), 0.0);
    go(&mut stage, ARM, STRAIGHT);
    stage
}

#[test]
fn a_pose_is_held_with_two_kilograms_at_full_stretch() {
    let mut stage = stretched_with(2.0);
    let reach = stage.robot().limb(ARM).end_effector.location;
    let shoulder = stage.robot().limb(ARM).joint_origins[0];
    assert!((reach - shoulder).length() > 10.0, "stretched");
    let torque = stage.robot().joint(RobotJoint::RightS1).torque;
    let lever = (stage.place("payload").location - shoulder)
        .truncate()
        .length()
        / 10.0;
    let expected = 2.0 * 9.81 * f64::from(lever);
    assert!(
        (torque.abs() / expected - 1.0).abs() < 0.02,
        "{torque} instead of {expected} N m"
    );
    for _ in 0..10 * SECOND {
        stage.app.step(1);
        check_limits(stage.robot());
        let off = off(&stage, ARM, STRAIGHT);
        assert!(off < 0.1, "{off}°");
    }
}

#[test]
fn an_unreported_weight_is_held_too() {
    let mut stage = Stage::dynamic();
    go(&mut stage, ARM, STRAIGHT);
    let robot = stage.robot().clone();
    let hand = robot.limb(ARM).end_effector.location;
    let shoulder = robot.limb(ARM).joint_origins[0];
    // Laid across the wrist.
    let place = hand.lerp(shoulder, 0.2) + Vec3::Z * 1.6;
    stage.put(
        "weight",
        block(Vec3::new(4.0, 4.0, 1.0)),
        2.0,
        Pose::at(place),
    );
    let mut worst_off = 0.0_f64;
    for _ in 0..10 * SECOND {
        stage.app.step(1);
        check_limits(stage.robot());
        worst_off = worst_off.max(off(&stage, ARM, STRAIGHT));
    }
    let torque = stage.robot().joint(RobotJoint::RightS1).torque.abs();
    assert!(
        torque > 10.0,
        "it lies on the arm: {torque} N m, {:?}",
        stage.place("weight")
    );
    assert!(worst_off < 0.5, "{worst_off}°");
}

#[test]
fn a_velocity_is_kept() {
    let mut stage = Stage::dynamic();
    go(&mut stage, ARM, STRAIGHT);
    for (joint, velocity) in [
        (RobotJoint::RightS0, 0.7),
        (RobotJoint::RightE1, 1.2),
        (RobotJoint::RightW1, 1.0),
    ] {
        for tick in 0..45 {
            drive(&mut stage, &[(joint, Drive::Velocity(velocity))]);
            stage.app.step(1);
            check_limits(stage.robot());
            let is = stage.robot().joint(joint).velocity;
            assert!(
                tick < 15 || (is / velocity - 1.0).abs() < 0.03,
                "{joint}, tick {tick}: {is} rad/s"
            );
        }
        stage.app.step(30);
        let is = stage.robot().joint(joint).velocity;
        assert!(is.abs() < 1e-3, "{joint} stops: {is} rad/s");
    }
}

#[test]
fn a_torque_accelerates_as_the_masses_have_it() {
    let model = baxter().unwrap();
    for arm in Arm::BOTH {
        let mut stage = Stage::dynamic();
        let angles = stage.robot().angles(arm);
        let joints = RobotJoint::of_arm(arm);
        let torques = [4.0, -3.0, 2.0, -1.5, 0.3, -0.2, 0.02];
        let drives: Vec<_> = joints.into_iter().zip(torques.map(Drive::Torque)).collect();
        drive(&mut stage, &drives);
        stage.app.step(1);
        let mut configuration = model.zero();
        let mut accelerations = model.zero();
        for (joint, angle) in joints.into_iter().zip(angles) {
            let id = model.find_joint(joint.name().as_str()).unwrap();
            configuration[id] = angle;
            accelerations[id] = stage.robot().joint(joint).velocity / SECONDS;
        }
        let frames = model.frames(&configuration);
        let gravity = bevy::math::DVec3::ZERO;
        let found = model.inverse_dynamics(&frames, &model.zero(), &accelerations, gravity, &[]);
        for (joint, torque) in joints.into_iter().zip(torques) {
            let state = stage.robot().joint(joint);
            let needs =
                found[model.find_joint(joint.name().as_str()).unwrap()] + 0.7 * state.velocity;
            assert!(
                (needs - torque).abs() < 1e-3,
                "{joint}: {needs} instead of {torque} N m"
            );
            assert_eq!(state.torque, torque);
        }
    }
}

#[test]
fn a_joint_stays_where_it_is_when_its_torque_ends() {
    let mut stage = Stage::dynamic();
    go(&mut stage, ARM, STRAIGHT);
    for _ in 0..20 {
        drive(&mut stage, &[(RobotJoint::RightS0, Drive::Torque(-8.0))]);
        stage.app.step(1);
    }
    let at = stage.robot().joint(RobotJoint::RightS0).position;
    assert!(at < -0.03, "it has moved: {at}");
    stage.app.step(SECOND);
    let then = stage.robot().joint(RobotJoint::RightS0);
    assert!(
        (then.position - at).abs() < 0.03,
        "{} after {at}",
        then.position
    );
    assert_eq!(then.velocity, 0.0);
}

#[test]
fn a_position_is_reached_as_fast_as_the_motors_can() {
    let mut stage = Stage::dynamic();
    go(&mut stage, ARM, STRAIGHT);
    let mut goal = STRAIGHT;
    goal[0] = 0.6;
    goal[6] = -2.0;
    drive(
        &mut stage,
        &[
            (RobotJoint::RightS0, Drive::Position(goal[0])),
            (RobotJoint::RightW2, Drive::Position(goal[6])),
        ],
    );
    for tick in 0..70 {
        stage.app.step(1);
        check_limits(stage.robot());
        let past = stage.robot().joint(RobotJoint::RightS0).position - goal[0];
        assert!(past < 0.01, "tick {tick}: {past} rad past the goal");
    }
    let off = off(&stage, ARM, goal);
    assert!(off < 0.1, "{off}°: {:?}", stage.robot().angles(ARM));
    assert!(!stage.robot().limb(ARM).is_moving);
}

/// Kinetic energy of an arm, in J.
fn energy(stage: &Stage, arm: Arm) -> f64 {
    let model = baxter().unwrap();
    let mut configuration = model.zero();
    let states = RobotJoint::of_arm(arm).map(|joint| {
        let id = model.find_joint(joint.name().as_str()).unwrap();
        configuration[id] = stage.robot().joint(joint).position;
        (id, stage.robot().joint(joint).velocity)
    });
    let inertia = model.inertia_matrix(&model.frames(&configuration), &[]);
    let momentum = |i| {
        states
            .iter()
            .map(|(j, velocity)| inertia[(i, *j)] * velocity)
            .sum::<f64>()
    };
    0.5 * states
        .iter()
        .map(|(i, velocity)| velocity * momentum(*i))
        .sum::<f64>()
}

#[test]
fn a_free_arm_loses_energy_only_to_damping() {
    let mut stage = Stage::dynamic();
    go(&mut stage, ARM, [0.0, -0.6, 0.3, 0.6, 0.2, 0.5, 0.0]);
    let joints = RobotJoint::of_arm(ARM);
    let velocities = [0.8, -0.4, 1.0, 0.5, -1.0, 1.0, 2.0];
    for _ in 0..20 {
        let drives: Vec<_> = joints
            .into_iter()
            .zip(velocities.map(Drive::Velocity))
            .collect();
        drive(&mut stage, &drives);
        stage.app.step(1);
    }
    let before = energy(&stage, ARM);
    let mut lost = 0.0;
    for _ in 0..30 {
        drive(&mut stage, &joints.map(|joint| (joint, Drive::Torque(0.0))));
        stage.app.step(1);
        check_limits(stage.robot());
        let squares = joints.map(|joint| stage.robot().joint(joint).velocity.powi(2));
        lost += 0.7 * SECONDS * squares.iter().sum::<f64>();
    }
    let after = energy(&stage, ARM);
    assert!(
        ((before - lost) / after - 1.0).abs() < 0.05,
        "{before} J - {lost} J = {after} J"
    );
    assert_eq!(stage.robot().limb(ARM).blocked_by, None);
}

fn any_drive() -> impl Strategy<Value = (RobotJoint, Drive)> {
    let drive = prop_oneof![
        3 => (-50.0..50.0).prop_map(Drive::Velocity),
        2 => (-3.2..3.2).prop_map(Drive::Position),
        2 => (-4.0..4.0).prop_map(Drive::Toward),
        3 => (-80.0..80.0).prop_map(Drive::Torque),
    ];
    (0..14usize, drive).prop_map(|(joint, drive)| (RobotJoint::ALL[joint], drive))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn no_command_brings_a_joint_beyond_its_limits(
        drives in proptest::collection::vec(proptest::collection::vec(any_drive(), 1..10), 1..60),
        is_shown: bool,
    ) {
        let mut stage = Stage::dynamic();
        stage.tell(RobotCommand::Show(is_shown));
        for (i, mass) in [0.2, 2.0, 50.0].into_iter().enumerate() {
            let place = Vec3::new(3.0 * i as f32 - 3.0, -3.5, 0.5);
            stage.put(&format!("block{i}"), block(Vec3::ONE), mass, Pose::at(place));
        }
        for drives in drives {
            for _ in 0..5 {
                drive(&mut stage, &drives);
                stage.app.step(1);
                check_limits(stage.robot());
                if !is_shown {
                    continue;
                }
                let inside = kit::inside_the_table(&mut stage);
                prop_assert!(inside.is_empty(), "{:?}", inside);
            }
        }
    }
}

#[test]
fn undo_takes_the_motors_back_too() {
    let mut stage = Stage::dynamic();
    stage.put(
        "thing",
        block(Vec3::ONE),
        1.0,
        Pose::at(Vec3::new(-3.0, 0.0, 0.5)),
    );
    stage.app.world_mut().resource_mut::<Recording>().0 = true;
    drive(&mut stage, &[(RobotJoint::RightE1, Drive::Toward(1.0))]);
    stage.app.step(30);
    let joints = stage.robot().joints.clone();
    stage.tell(HandCommand::Grasp {
        hand: Hand::Left,
        object: "thing".into(),
    });
    stage.app.step(30);
    let then = stage.robot().joints.clone();
    stage.tell(HistoryCommand::Undo);
    stage.app.step(30);
    assert_ne!(joints, then);
    assert_eq!(
        stage.robot().joints,
        then,
        "it goes on as it did the first time"
    );
}

#[test]
fn a_hidden_robot_keeps_its_angles_and_stops() {
    let mut stage = Stage::dynamic();
    drive(&mut stage, &[(RobotJoint::RightS1, Drive::Velocity(-1.0))]);
    stage.app.step(3);
    let angles = stage.robot().angles(ARM);
    stage.tell(RobotCommand::Show(false));
    stage.app.step(1);
    assert_eq!(stage.robot().angles(ARM), angles);
    assert!(
        stage
            .robot()
            .joints
            .iter()
            .all(|joint| joint.velocity == 0.0)
    );
}
