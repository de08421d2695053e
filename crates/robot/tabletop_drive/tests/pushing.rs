//! Objects that arms with motors push, and obstacles that stop them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{
    Stage, block,
    motors::{ARM, SECOND, check_limits, drive, effort},
};
use tabletop_core::{
    Drive, Obstacle, Robot, RobotCommand, RobotFact, RobotJoint, SimFact, StepApp, TICK_SECONDS,
};
use tabletop_geometry::Pose;

#[test]
fn a_swing_into_a_fixed_block_stops_there_within_the_efforts() {
    let mut stage = Stage::dynamic();
    stage.reach(ARM, Vec3::new(6.0, -1.5, 1.2), 0.0);
    stage.put(
        "wall",
        block(Vec3::new(1.0, 6.0, 4.0)),
        0.0,
        Pose::at(Vec3::new(0.0, -3.0, 2.0)),
    );
    stage.app.step(1);
    let (mut fastest, mut strongest) = (0.0_f32, 0.0_f64);
    let mut facts = Vec::new();
    let mut before = stage.robot().limb(ARM).end_effector.location;
    for _ in 0..2 * SECOND {
        drive(&mut stage, &[(RobotJoint::RightS0, Drive::Velocity(1.5))]);
        facts.extend(stage.facts_of(1));
        check_limits(stage.robot());
        let hand = stage.robot().limb(ARM).end_effector;
        fastest = fastest.max((hand.location - before).length() / TICK_SECONDS);
        before = hand.location;
        strongest = strongest.max(stage.robot().joint(RobotJoint::RightS0).torque.abs());
        let left_finger = hand * Vec3::new(-1.3, 0.0, 0.0);
        assert!(left_finger.x > 0.5, "{left_finger} is in the wall");
    }
    assert!(fastest > 10.0, "{fastest} units/s");
    assert!(strongest > 40.0, "it pressed: {strongest} N m");
    let blocked = SimFact::Robot(RobotFact::ArmBlocked {
        arm: ARM.name(),
        by: Obstacle::Object("wall".into()),
    });
    assert_eq!(facts, [blocked]);
}

/// The result of pushing a block along the table for a second.
struct Pushed {
    /// Distance of the hand, in units.
    hand: f32,
    /// Distance of the block, in units.
    block: f32,
    /// Largest share of its effort with which a motor has pulled while touching the block.
    strongest: f64,
    facts: Vec<SimFact>,
    robot: Robot,
}

fn push(mass: f32, is_there: bool) -> Pushed {
    let mut stage = Stage::dynamic();
    stage.reach(ARM, Vec3::new(2.0, -3.0, 0.9), 0.0);
    drive(
        &mut stage,
        &[(RobotJoint::gripper(ARM), Drive::Toward(0.2))],
    );
    stage.app.step(120);
    let x = if is_there { 4.0 } else { -4.0 };
    stage.put(
        "thing",
        block(Vec3::ONE),
        mass,
        Pose::at(Vec3::new(x, -3.0, 0.5)),
    );
    stage.facts_of(30);
    let pose = Pose::at(Vec3::new(7.0, -3.0, 0.9));
    stage.tell(RobotCommand::ReachTo {
        arm: ARM.name(),
        pose,
    });
    let mut strongest = 0.0_f64;
    let mut facts = Vec::new();
    for tick in 0..SECOND {
        facts.extend(stage.facts_of(1));
        check_limits(stage.robot());
        if tick > 10 {
            let shares = RobotJoint::of_arm(ARM)
                .map(|joint| stage.robot().joint(joint).torque.abs() / effort(joint));
            strongest = shares.into_iter().fold(strongest, f64::max);
        }
    }
    Pushed {
        hand: stage.robot().limb(ARM).end_effector.location.x - 2.0,
        block: stage.place("thing").location.x - x,
        strongest,
        facts,
        robot: stage.robot().clone(),
    }
}

#[test]
fn a_light_block_is_pushed_and_a_heavy_one_stalls_the_arm() {
    let free = push(0.2, false).hand;
    let light = push(0.2, true);
    assert!(light.block > 2.5, "the light block came {}", light.block);
    assert!(
        light.hand > 0.97 * free,
        "the hand came {} instead of {free}",
        light.hand
    );
    let middle = push(5.0, true);
    assert!(
        middle.block > 1.0 && middle.hand < free,
        "{} {}",
        middle.block,
        middle.hand
    );
    let heavy = push(50.0, true);
    assert!(heavy.block < 0.01, "the heavy block came {}", heavy.block);
    assert!(heavy.hand < 2.0, "the hand came {}", heavy.hand);
    assert_eq!(heavy.strongest, 1.0);
    let blocked = SimFact::Robot(RobotFact::ArmBlocked {
        arm: ARM.name(),
        by: Obstacle::Object("thing".into()),
    });
    assert_eq!(heavy.facts, [blocked]);
}

#[test]
fn an_arm_that_presses_a_block_onto_the_table_stops() {
    let mut stage = Stage::dynamic();
    stage.put(
        "thing",
        block(Vec3::ONE),
        1.0,
        Pose::at(Vec3::new(3.0, -3.0, 0.5)),
    );
    drive(
        &mut stage,
        &[(RobotJoint::RightGripper, Drive::Toward(0.2))],
    );
    stage.reach(ARM, Vec3::new(3.0, -3.0, 2.5), 0.0);
    stage.app.step(60);
    let pose = Pose::at(Vec3::new(3.0, -3.0, 0.9));
    stage.tell(RobotCommand::ReachTo {
        arm: ARM.name(),
        pose,
    });
    for _ in 0..3 * SECOND {
        stage.app.step(1);
        check_limits(stage.robot());
    }
    assert_eq!(
        stage.robot().limb(ARM).blocked_by,
        Some(Obstacle::Object("thing".into()))
    );
    let hand = stage.robot().limb(ARM).end_effector.location;
    assert!(
        hand.truncate().distance(Vec2::new(3.0, -3.0)) < 0.3,
        "it does not slip: {hand}"
    );
    let place = stage.place("thing").location;
    assert!(
        (place - Vec3::new(3.0, -3.0, 0.5)).length() < 0.2,
        "{place}"
    );
}

#[test]
fn equal_runs_end_in_equal_states() {
    let run = || {
        let pushed = push(1.0, true);
        (pushed.robot.joints, pushed.block)
    };
    assert_eq!(run(), run());
}
