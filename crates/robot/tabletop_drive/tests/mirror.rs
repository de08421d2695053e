//! The simulated robot as a mirror of a real one.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{Stage, block};
use tabletop_core::{
    Arm, ClockCommand, Drive, JointName, MeasuredJoint, RobotCommand, RobotFact, RobotJoint,
    SimFact, StepApp as _,
};
use tabletop_geometry::Pose;

/// Angles with which the left arm reaches down through the table.
const THROUGH_THE_TABLE: [(RobotJoint, f64); 3] = [
    (RobotJoint::LeftS1, 0.9),
    (RobotJoint::LeftE1, 0.0),
    (RobotJoint::LeftW1, 0.0),
];

fn at(position: f64) -> MeasuredJoint {
    MeasuredJoint {
        position,
        ..MeasuredJoint::default()
    }
}

fn mirror(measured: impl IntoIterator<Item = (RobotJoint, MeasuredJoint)>) -> RobotCommand {
    let measured = measured.into_iter();
    RobotCommand::Mirror(measured.map(|(joint, it)| (joint.name(), it)).collect())
}

fn drive(drives: impl IntoIterator<Item = (RobotJoint, f64)>) -> RobotCommand {
    let drives = drives.into_iter();
    RobotCommand::drive(drives.map(|(joint, there)| (joint, Drive::Position(there))))
}

#[test]
fn its_joints_are_where_they_were_measured_whatever_is_in_the_way() {
    let mut stage = Stage::new();
    stage.tell(drive(THROUGH_THE_TABLE));
    stage.app.step(5);
    let is_there = |stage: &Stage| {
        let mut joints = THROUGH_THE_TABLE.iter();
        joints.all(|(joint, there)| stage.robot().joint(*joint).position == *there)
    };
    assert!(!is_there(&stage), "the simulated arm passes the table");
    assert!(stage.robot().limb(Arm::Left).blocked_by.is_some());

    for _ in 0..3 {
        let measured = THROUGH_THE_TABLE.map(|(joint, position)| {
            let measured = MeasuredJoint {
                position,
                velocity: -0.25,
                torque: 4.0,
                grips: None,
            };
            (joint, measured)
        });
        stage.tell(mirror(measured));
        let facts = stage.facts_of(1);
        assert!(is_there(&stage));
        assert!(stage.robot().is_mirror);
        let state = stage.robot().joint(RobotJoint::LeftS1);
        assert_eq!([state.velocity, state.torque], [-0.25, 4.0]);
        assert_eq!(stage.robot().limb(Arm::Left).blocked_by, None);
        let is_blocked =
            |fact: &SimFact| matches!(fact, SimFact::Robot(RobotFact::ArmBlocked { .. }));
        assert!(!facts.iter().any(is_blocked), "{facts:?}");
    }
    // Out of the table's sight and back, it is there, too.
    stage.tell(RobotCommand::Show(false));
    stage.tell(RobotCommand::Show(true));
    stage.tell(mirror(THROUGH_THE_TABLE.map(|(joint, it)| (joint, at(it)))));
    stage.app.step(1);
    assert!(is_there(&stage));

    stage.app.step(1);
    assert!(!stage.robot().is_mirror);
    let state = stage.robot().joint(RobotJoint::LeftS1);
    assert_eq!([state.velocity, state.torque], [0.0, 0.0]);
}

#[test]
fn it_takes_the_place_of_drives_and_joints_that_were_not_measured_stand_still() {
    let mut stage = Stage::new();
    stage.tell(RobotCommand::drive([
        (RobotJoint::LeftW2, Drive::Toward(1.0)),
        (RobotJoint::RightW2, Drive::Toward(1.0)),
    ]));
    stage.app.step(3);
    let right = stage.robot().joint(RobotJoint::RightW2).position;
    stage.tell(mirror([(RobotJoint::LeftW2, at(0.3))]));
    stage.tell(drive([(RobotJoint::LeftW2, -0.3)]));
    stage.app.step(1);
    assert_eq!(stage.robot().joint(RobotJoint::LeftW2).position, 0.3);
    assert_eq!(stage.robot().joint(RobotJoint::RightW2).position, right);
    assert_eq!(stage.robot().joint(RobotJoint::RightW2).velocity, 0.0);
}

#[test]
fn what_is_no_number_or_of_no_joint_is_refused_and_so_is_all_in_a_pause() {
    let mut stage = Stage::new();
    let refusal = |stage: &mut Stage, command: RobotCommand| {
        stage.tell(command);
        let facts = stage.facts_of(1).into_iter();
        let mut reasons = facts.filter_map(|fact| match fact {
            SimFact::Refused { reason, .. } => Some(reason),
            SimFact::Scene(_)
            | SimFact::History(_)
            | SimFact::Mechanism(_)
            | SimFact::Hand(_)
            | SimFact::Recording(_)
            | SimFact::Robot(_) => None,
        });
        reasons.next_back().unwrap()
    };
    let nowhere = mirror([(RobotJoint::LeftS0, at(f64::NAN))]);
    assert!(refusal(&mut stage, nowhere).contains("left_s0"));
    let unknown = RobotCommand::Mirror(vec![(JointName::new("elbow").unwrap(), at(0.0))]);
    assert!(refusal(&mut stage, unknown).contains("no joint elbow"));
    stage.tell(ClockCommand::SetPaused(true));
    let paused = mirror([(RobotJoint::LeftS0, at(0.0))]);
    assert!(refusal(&mut stage, paused).contains("paused"));
    assert!(!stage.robot().is_mirror);
    let mut stage = Stage::dynamic();
    let with_motors = mirror([(RobotJoint::LeftS0, at(0.0))]);
    assert!(refusal(&mut stage, with_motors).contains("motors"));
}

/// A stage whose left gripper is around a block a unit wide, and the measured joints of that arm.
fn around_a_block() -> (Stage, Vec<(RobotJoint, MeasuredJoint)>) {
    let mut stage = Stage::new();
    let place = Vec3::new(-3.0, -2.0, 0.5);
    stage.reach(Arm::Left, place + Vec3::Z * 0.35, 0.0);
    stage.put("cube", block(Vec3::ONE), 0.1, Pose::at(place));
    stage.app.step(5);
    let joints = RobotJoint::of_arm(Arm::Left);
    let measured = joints.map(|joint| (joint, at(stage.robot().joint(joint).position)));
    (stage, measured.to_vec())
}

/// Lets the left gripper be open so far, and say this.
fn say(
    stage: &mut Stage,
    arm: &[(RobotJoint, MeasuredJoint)],
    opening: f64,
    grips: Option<bool>,
) -> usize {
    let gripper = MeasuredJoint {
        grips,
        ..at(opening)
    };
    let arm = arm.iter().copied();
    stage.tell(mirror(arm.chain([(RobotJoint::LeftGripper, gripper)])));
    stage.app.step(1);
    let limb = stage.robot().limb(Arm::Left);
    assert_eq!(limb.says_it_grips, grips);
    assert_eq!(
        stage.robot().joint(RobotJoint::LeftGripper).position,
        opening
    );
    limb.holds.len()
}

#[test]
fn a_gripper_holds_what_is_between_its_fingers_only_as_long_as_it_says_so() {
    let (mut stage, arm) = around_a_block();
    // It closes, and says nothing of a thing that the simulation has between its fingers.
    for opening in [1.5, 1.2, 1.0, 0.95] {
        assert_eq!(say(&mut stage, &arm, opening, Some(false)), 0);
    }
    // The real thing is a little thinner.
    assert_eq!(say(&mut stage, &arm, 0.95, Some(true)), 1);
    assert_eq!(say(&mut stage, &arm, 0.95, Some(true)), 1);
    let before = stage.place("cube");
    let mut lifted = arm.clone();
    for _ in 0..20 {
        for (joint, it) in &mut lifted {
            if *joint == RobotJoint::LeftS1 {
                it.position -= 0.01;
            }
        }
        assert_eq!(say(&mut stage, &lifted, 0.95, Some(true)), 1);
    }
    assert!(stage.place("cube").location.z > before.location.z + 0.5);
    assert_eq!(say(&mut stage, &lifted, 0.95, Some(false)), 0);
    for _ in 0..120 {
        assert_eq!(say(&mut stage, &lifted, 1.8, Some(false)), 0);
    }
    assert!(stage.place("cube").location.z < before.location.z + 0.1);
}

#[test]
fn a_gripper_holds_nothing_of_another_thickness() {
    let (mut stage, arm) = around_a_block();
    assert_eq!(say(&mut stage, &arm, 1.5, Some(true)), 0);
    assert_eq!(say(&mut stage, &arm, 0.3, Some(true)), 0);
}
