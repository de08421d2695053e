//! Motion of the robot in kinematic mode.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use std::f32::consts::PI;

use bevy::prelude::*;
use bevy_rapier3d::{prelude::Collider, rapier::prelude as rapier};
use kit::{Stage, block, inside_the_table};
use proptest::prelude::*;
use tabletop_core::{
    Arm, Drive, Hand, HandCommand, HeadCamera, HistoryCommand, ObjectIndex, Obstacle, Robot,
    RobotCommand, RobotFact, RobotJoint, SimFact, StepApp, TICK_SECONDS,
};
use tabletop_geometry::Pose;
use tabletop_robot::RobotLink;

fn drive(stage: &mut Stage, joint: RobotJoint, drive: Drive) {
    stage.tell(RobotCommand::drive([(joint, drive)]));
}

#[test]
fn a_velocity_moves_a_joint_for_one_tick() {
    let mut stage = Stage::new();
    let joint = RobotJoint::LeftS0;
    drive(&mut stage, joint, Drive::Velocity(0.6));
    stage.app.step(1);
    let state = *stage.robot().joint(joint);
    assert!((state.position - joint.home() - 0.6 * f64::from(TICK_SECONDS)).abs() < 1e-12);
    assert!((state.velocity - 0.6).abs() < 1e-9);
    stage.app.step(1);
    assert_eq!(stage.robot().joint(joint).position, state.position);
    assert_eq!(stage.robot().joint(joint).velocity, 0.0);
}

#[test]
fn the_neck_turns_the_camera_and_the_hidden_robot_moves() {
    let mut stage = Stage::new();
    stage.tell(RobotCommand::Show(false));
    drive(&mut stage, RobotJoint::HeadPan, Drive::Position(0.5));
    drive(&mut stage, RobotJoint::RightW2, Drive::Position(1.0));
    stage.app.step(1);
    assert_eq!(stage.app.world().resource::<HeadCamera>().pan, 0.5);
    assert_eq!(stage.robot().joint(RobotJoint::RightW2).position, 1.0);
}

#[test]
fn hands_pass_through_where_the_hidden_robot_was() {
    let mut stage = Stage::new();
    let place = Vec3::new(3.0, -2.0, 4.5);
    stage.reach(Arm::Right, place - Vec3::Z * 2.5, 0.0);
    let start = Pose::at(Vec3::new(3.0, 3.0, 0.5));
    stage.put("thing", block(Vec3::ONE), 1.0, start);
    stage.tell(RobotCommand::Show(false));
    stage.app.step(5);
    let hand = Hand::Left;
    let object = "thing".into();
    stage.tell(HandCommand::Grasp { hand, object });
    for location in [start.location + Vec3::Z * 1.5, place] {
        stage.tell(HandCommand::MoveTo { hand, location });
        stage.app.step(60);
    }
    let there = stage.place("thing").location;
    assert!(there.distance(place) < 1e-4, "{there}");
}

#[test]
fn an_arm_that_went_into_the_table_while_hidden_is_home_when_shown() {
    let mut stage = Stage::new();
    stage.tell(RobotCommand::Show(false));
    let down = [
        (RobotJoint::LeftS1, 1.0),
        (RobotJoint::LeftE1, 0.0),
        (RobotJoint::RightW2, 0.5),
    ];
    let down = down.map(|(joint, at)| (joint, Drive::Position(at)));
    stage.tell(RobotCommand::drive(down));
    stage.app.step(2);
    assert!(!inside_the_table(&mut stage).is_empty());
    stage.tell(RobotCommand::Show(true));
    let facts = stage.facts_of(2);
    let blocked = |fact: &SimFact| matches!(fact, SimFact::Robot(RobotFact::ArmBlocked { arm, .. }) if *arm == Arm::Left.name());
    assert!(facts.iter().any(blocked), "{facts:?}");
    assert!(inside_the_table(&mut stage).is_empty());
    let robot = stage.robot();
    assert_eq!(
        robot.joint(RobotJoint::LeftE1).position,
        RobotJoint::LeftE1.home()
    );
    assert_eq!(robot.joint(RobotJoint::RightW2).position, 0.5);
}

#[test]
fn an_arm_stops_at_the_table_and_says_so_once() {
    let mut stage = Stage::new();
    stage.reach(Arm::Right, Vec3::new(3.0, -3.0, 1.5), 0.0);
    let mut facts = Vec::new();
    for _ in 0..120 {
        drive(&mut stage, RobotJoint::RightS1, Drive::Velocity(1.0));
        facts.extend(stage.facts_of(1));
    }
    let blocked = SimFact::Robot(RobotFact::ArmBlocked {
        arm: Arm::Right.name(),
        by: Obstacle::Table,
    });
    assert_eq!(facts, [blocked]);
    let tip = stage.robot().limb(Arm::Right).end_effector * Vec3::new(0.0, 0.0, -0.75);
    assert!((0.0..0.3).contains(&tip.z), "{tip}");
    // It can go back.
    drive(&mut stage, RobotJoint::RightS1, Drive::Velocity(-1.0));
    stage.app.step(1);
    assert_eq!(stage.robot().limb(Arm::Right).blocked_by, None);
}

#[test]
fn an_arm_stops_at_a_fixed_object_and_pushes_a_free_one() {
    for (mass, moves) in [(0.0, false), (1.0, true)] {
        let mut stage = Stage::new();
        stage.reach(Arm::Right, Vec3::new(2.0, -3.0, 0.9), 0.0);
        drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
        stage.put(
            "thing",
            block(Vec3::ONE),
            mass,
            Pose::at(Vec3::new(4.0, -3.0, 0.5)),
        );
        let pose = Pose::at(Vec3::new(5.0, -3.0, 0.9));
        stage.tell(RobotCommand::ReachTo {
            arm: Arm::Right.name(),
            pose,
        });
        let facts = stage.facts_of(200);
        let is_blocked = facts
            .iter()
            .any(|fact| matches!(fact, SimFact::Robot(RobotFact::ArmBlocked { by: Obstacle::Object(id), .. }) if id == "thing"));
        assert_eq!(is_blocked, !moves, "{facts:?}");
        let place = stage.place("thing").location;
        assert_eq!(place.x > 5.0, moves, "{place}");
    }
}

#[test]
fn an_arm_names_the_nearest_of_the_things_in_its_way() {
    for shift in 0..6_u8 {
        let mut stage = Stage::new();
        stage.reach(Arm::Right, Vec3::new(2.0, -3.0, 0.9), 0.0);
        let wall = block(Vec3::new(1.0, 4.0, 1.0));
        let near = Vec3::new(4.0 + 0.03 * f32::from(shift), -3.0, 0.5);
        for (id, behind) in [("far", 0.05), ("near", 0.0)] {
            let place = Pose::at(near + Vec3::X * behind);
            stage.put(id, wall.clone(), 0.0, place);
        }
        stage.app.step(1);
        let s0 = RobotJoint::RightS0;
        let turned = stage.robot().joint(s0).position - 0.5;
        drive(&mut stage, s0, Drive::Position(turned));
        stage.app.step(1);
        let by = stage.robot().limb(Arm::Right).blocked_by.clone();
        assert_eq!(
            by,
            Some(Obstacle::Object("near".into())),
            "shifted by {shift}"
        );
    }
}

#[test]
fn the_arms_do_not_enter_each_other() {
    let mut stage = Stage::new();
    stage.reach(Arm::Right, Vec3::new(2.0, -3.0, 3.0), 0.0);
    stage.reach(Arm::Left, Vec3::new(-2.0, -3.0, 3.0), 0.0);
    let pose = Pose::at(Vec3::new(3.0, -3.0, 3.0));
    stage.tell(RobotCommand::ReachTo {
        arm: Arm::Left.name(),
        pose,
    });
    let facts = stage.facts_of(300);
    let is_blocked = facts.iter().any(
        |fact| matches!(fact, SimFact::Robot(RobotFact::ArmBlocked { arm, by: Obstacle::Link(link) }) if *arm == Arm::Left.name() && link.contains("right")),
    );
    assert!(is_blocked, "{facts:?}");
}

#[test]
fn a_held_object_goes_no_deeper_into_the_table_than_it_gives() {
    let mut stage = Stage::new();
    stage.reach(Arm::Right, Vec3::new(3.0, -2.0, 1.7), 0.0);
    stage.put(
        "tall",
        block(Vec3::new(1.0, 1.0, 2.0)),
        1.0,
        Pose::at(Vec3::new(3.0, -2.0, 1.0)),
    );
    drive(&mut stage, RobotJoint::RightGripper, Drive::Toward(0.0));
    stage.app.step(120);
    assert_eq!(stage.robot().limb(Arm::Right).holds.len(), 1);
    stage.reach(Arm::Right, Vec3::new(3.0, -2.0, 2.7), 0.0);
    for _ in 0..200 {
        drive(&mut stage, RobotJoint::RightS1, Drive::Velocity(1.0));
        stage.app.step(1);
    }
    let place = stage.place("tall");
    let lowest = [-0.5f32, 0.5]
        .into_iter()
        .flat_map(|x| [-0.5f32, 0.5].map(|y| (place * Vec3::new(x, y, -1.0)).z))
        .fold(f32::INFINITY, f32::min);
    assert!((-0.03..0.2).contains(&lowest), "{lowest}");
}

#[test]
fn a_pose_out_of_reach_is_refused() {
    let mut stage = Stage::new();
    let pose = Pose::at(Vec3::new(30.0, 0.0, 1.0));
    stage.tell(RobotCommand::ReachTo {
        arm: Arm::Left.name(),
        pose,
    });
    let facts = stage.facts_of(1);
    assert!(
        matches!(&facts[..], [SimFact::Refused { reason, .. }] if reason.contains("cannot reach")),
        "{facts:?}"
    );
}

#[test]
fn undo_takes_the_robot_back_too() {
    let mut stage = Stage::new();
    stage.put(
        "thing",
        block(Vec3::ONE),
        1.0,
        Pose::at(Vec3::new(-3.0, 0.0, 0.5)),
    );
    stage
        .app
        .world_mut()
        .resource_mut::<tabletop_core::Recording>()
        .0 = true;
    stage.app.step(1);
    let before = stage.robot().clone();
    stage.tell(HandCommand::Grasp {
        hand: tabletop_core::Hand::Left,
        object: "thing".into(),
    });
    drive(&mut stage, RobotJoint::RightE1, Drive::Toward(1.0));
    stage.app.step(30);
    assert_ne!(stage.robot(), &before);
    stage.tell(HistoryCommand::Undo);
    stage.app.step(1);
    assert_eq!(stage.robot().joints, before.joints);
    assert_eq!(
        stage.robot().limbs[1].end_effector,
        before.limbs[1].end_effector
    );
}

fn any_drive() -> impl Strategy<Value = (RobotJoint, Drive)> {
    let drive = prop_oneof![
        4 => (-50.0..50.0).prop_map(Drive::Velocity),
        1 => (-PI..PI).prop_map(|position| Drive::Position(f64::from(position))),
        2 => (-4.0..4.0).prop_map(Drive::Toward),
    ];
    (0..17usize, drive).prop_map(|(joint, drive)| (RobotJoint::ALL[joint], drive))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn no_command_brings_a_joint_out_of_its_limits_or_a_link_into_the_table(
        acts in proptest::collection::vec(
            (proptest::bool::weighted(0.8), proptest::collection::vec(any_drive(), 1..6)),
            1..60,
        ),
    ) {
        let mut stage = Stage::new();
        for (is_shown, drives) in acts {
            stage.tell(RobotCommand::Show(is_shown));
            stage.tell(RobotCommand::drive(drives));
            stage.app.step(3);
            for joint in RobotJoint::ALL {
                let position = stage.robot().joint(joint).position;
                prop_assert_eq!(joint.clamp(position), position, "{}", joint);
            }
            let inside = inside_the_table(&mut stage);
            prop_assert!(inside.is_empty() || !is_shown, "{:?}", inside);
        }
    }
}

#[test]
fn equal_runs_end_in_equal_states() {
    let run = || -> (Robot, Pose) {
        let mut stage = Stage::new();
        stage.reach(Arm::Right, Vec3::new(3.0, -2.0, 0.9), 0.0);
        stage.put(
            "thing",
            block(Vec3::ONE),
            1.0,
            Pose::at(Vec3::new(3.2, -2.0, 0.5)),
        );
        drive(&mut stage, RobotJoint::RightGripper, Drive::Toward(0.0));
        stage.app.step(100);
        (stage.robot().clone(), stage.place("thing"))
    };
    let (robot, place) = run();
    let (again, place_again) = run();
    assert_eq!(robot.joints, again.joints);
    assert_eq!(place, place_again);
}

#[test]
fn an_arm_that_presses_a_block_onto_the_table_stops() {
    let mut stage = Stage::new();
    stage.put(
        "thing",
        block(Vec3::ONE),
        1.0,
        Pose::at(Vec3::new(3.0, -3.0, 0.5)),
    );
    drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
    stage.reach(Arm::Right, Vec3::new(3.0, -3.0, 2.5), 0.0);
    let pose = Pose::at(Vec3::new(3.0, -3.0, 0.9));
    stage.tell(RobotCommand::ReachTo {
        arm: Arm::Right.name(),
        pose,
    });
    stage.app.step(140);
    assert_eq!(
        stage.robot().limb(Arm::Right).blocked_by,
        Some(Obstacle::Object("thing".into()))
    );
    let place = stage.place("thing").location;
    assert!(
        (place - Vec3::new(3.0, -3.0, 0.5)).length() < 0.2,
        "{place}"
    );
}

#[test]
fn an_arm_shown_in_a_block_pushes_it_once_it_has_left_it() {
    let mut stage = Stage::new();
    let corner = Vec3::new(3.0, -3.0, 0.5);
    drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
    stage.reach(Arm::Right, corner.with_z(1.0), 0.0);
    stage.tell(RobotCommand::Show(false));
    stage.app.step(1);
    stage.put("block", block(Vec3::ONE), 1.0, Pose::at(corner));
    stage.app.step(60);
    stage.tell(RobotCommand::Show(true));
    for height in [1.0, 1.2, 4.0] {
        stage.reach(Arm::Right, corner.with_z(height), 0.0);
        stage.app.step(60);
        let moved = stage.place("block").location.distance(corner);
        assert!(moved < 0.001, "{moved} at {height}");
    }
    for beside in [
        Vec3::new(5.5, -3.0, 4.0),
        Vec3::new(5.5, -3.0, 1.0),
        Vec3::new(3.5, -3.0, 1.0),
    ] {
        stage.reach(Arm::Right, beside, 0.0);
    }
    let moved = stage.place("block").location.distance(corner);
    assert!(moved > 0.1, "{moved}");
}

#[test]
fn an_arm_lets_a_crushed_block_out_of_the_table() {
    let mut stage = Stage::new();
    drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
    let place = Vec3::new(3.0, -3.0, 0.3);
    stage.reach(Arm::Right, place.with_z(1.2), 0.0);
    stage.put("crushed", block(Vec3::ONE), 1.0, Pose::at(place));
    stage.app.step(60);
    let height = stage.place("crushed").location.z;
    assert!(height > 0.48, "{height}");
}

/// Height of the lowest point of the right arm.
fn lowest(stage: &mut Stage) -> f32 {
    let world = stage.app.world_mut();
    let mut links = world.query::<(&RobotLink, &Transform, &Collider)>();
    let of_arm = links.iter(world);
    let of_arm = of_arm.filter(|(link, ..)| link.name.contains("right"));
    let heights = of_arm.map(|(_, place, collider)| {
        let at = rapier::Pose::from_parts(place.translation, place.rotation);
        collider.raw.compute_aabb(&at).mins.z
    });
    heights.fold(f32::INFINITY, f32::min)
}

#[test]
fn an_arm_that_stands_a_little_in_something_does_not_press_it_into_the_table() {
    let mut stage = Stage::new();
    drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
    let place = Vec3::new(3.0, -3.0, 0.5);
    stage.reach(Arm::Right, place.with_z(1.2), 0.0);
    let tip = lowest(&mut stage);
    for depth in [0.01, 0.02, 0.03, 0.04, 0.045, 0.048, 0.06, 0.1] {
        let id = format!("{depth} deep");
        let span = Vec3::new(1.0, 1.0, tip + depth);
        stage.put(&id, block(span), 1.0, Pose::at(place.with_z(span.z / 2.0)));
        for tick in 0..60 {
            stage.app.step(1);
            let low = stage.place(&id).location.z - span.z / 2.0;
            assert!(low > -0.03, "tick {tick}: {id}: {low}");
        }
        let object = stage
            .app
            .world()
            .resource::<ObjectIndex>()
            .get(&id)
            .unwrap();
        stage.app.world_mut().despawn(object);
    }
}

#[test]
fn an_arm_that_presses_a_tower_presses_nothing_into_the_table() {
    for blocks in 1..=3 {
        let mut stage = Stage::new();
        drive(&mut stage, RobotJoint::RightGripper, Drive::Position(0.2));
        stage.reach(Arm::Right, Vec3::new(3.0, -3.0, 5.5), 0.0);
        for number in 0..blocks {
            let place = Pose::at(Vec3::new(3.0, -3.0, 0.5 + number as f32));
            stage.put(&number.to_string(), block(Vec3::ONE), 1.0, place);
        }
        stage.tell(RobotCommand::ReachTo {
            arm: Arm::Right.name(),
            pose: Pose::at(Vec3::new(3.0, -3.0, 0.9)),
        });
        let mut is_pressed = false;
        for _ in 0..300 {
            stage.app.step(1);
            let contacts = &stage.robot().contacts;
            is_pressed |= contacts.iter().any(|contact| contact.impulse > 0.0);
            for number in 0..blocks {
                let Pose { location, rotation } = stage.place(&number.to_string());
                let half = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (rotation * axis).z.abs() / 2.0);
                let low = location.z - half.iter().sum::<f32>();
                assert!(low > -0.05, "block {number} of {blocks}: {low}");
            }
        }
        assert!(is_pressed, "{blocks}");
    }
}
