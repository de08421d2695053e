//! Grips of the grippers.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{Stage, block};
use tabletop_core::{
    Arm, Drive, HandCommand, LidBoxSpec, ObjectIndex, Part, Robot, RobotCommand, RobotFact,
    RobotJoint, RobotMode, SceneCommand, SceneItem, SceneSpec, Shape, SimFact, StepApp,
};
use tabletop_drive::STEEPEST_GRIP;
use tabletop_geometry::{Pose, Rgb};

const ARM: Arm = Arm::Right;

/// A wide open gripper over a place on the table, its fingers pointing down around an object there.
fn gripper_around(shape: Shape, mass: f32, place: Vec3, degrees: Vec3) -> Stage {
    let mut stage = Stage::new();
    stage.reach(ARM, Vec3::new(3.0, -2.0, place.z.max(0.85)), 0.0);
    stage.put(
        "thing",
        shape,
        mass,
        Pose::from_degrees(Vec3::new(3.0, -2.0, 0.0) + place, degrees),
    );
    stage.app.step(5);
    stage
}

fn close(stage: &mut Stage) -> Vec<SimFact> {
    stage.tell(RobotCommand::drive([(
        RobotJoint::gripper(ARM),
        Drive::Toward(0.0),
    )]));
    stage.facts_of(150)
}

fn grip_facts(facts: Vec<SimFact>) -> Vec<SimFact> {
    let is_grip = |fact: &SimFact| {
        matches!(
            fact,
            SimFact::Robot(
                RobotFact::GripMade { .. }
                    | RobotFact::GripRefused { .. }
                    | RobotFact::GripReleased { .. }
            )
        )
    };
    facts.into_iter().filter(is_grip).collect()
}

fn made() -> Vec<SimFact> {
    vec![SimFact::Robot(RobotFact::GripMade {
        arm: ARM.name(),
        id: "thing".into(),
    })]
}

fn unit_block() -> Shape {
    block(Vec3::ONE)
}

#[test]
fn a_block_is_held_lifted_carried_and_let_go_of() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    assert_eq!(grip_facts(close(&mut stage)), made());
    let opening = stage.robot().joint(RobotJoint::gripper(ARM)).position;
    assert!((opening - 1.0).abs() < 0.01, "{opening}");

    let place = stage.place("thing");
    let hand = stage.robot().limb(ARM).end_effector;
    stage.reach(ARM, Vec3::new(4.0, -1.0, 3.0), 40.0);
    let moved = stage.robot().limb(ARM).end_effector;
    let expected = moved * (hand.inverse() * place);
    assert!((stage.place("thing").location - expected.location).length() < 1e-3);

    stage.tell(RobotCommand::drive([(
        RobotJoint::gripper(ARM),
        Drive::Toward(2.0),
    )]));
    let facts = grip_facts(stage.facts_of(120));
    assert!(
        matches!(facts[..], [SimFact::Robot(RobotFact::GripReleased { .. })]),
        "{facts:?}"
    );
    assert!(stage.place("thing").location.z < 1.0);
}

#[test]
fn a_block_off_the_centre_is_pushed_there_and_held() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::new(0.2, 0.0, 0.5), Vec3::ZERO);
    assert_eq!(grip_facts(close(&mut stage)), made());
    let hand = stage.robot().limb(ARM).end_effector.location;
    let place = stage.place("thing").location;
    assert!((place.x - hand.x).abs() < 0.02, "{place} under {hand}");
}

#[test]
fn the_angle_of_figure_11_decides() {
    for degrees in [5.0, 10.0] {
        let turned = Vec3::Z * degrees;
        let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, turned);
        assert_eq!(grip_facts(close(&mut stage)), made(), "{degrees}°");
    }
}

#[test]
fn closing_fingers_turn_a_block_until_it_is_flush() {
    for (mode, degrees) in [RobotMode::Kinematic, RobotMode::Dynamic]
        .into_iter()
        .flat_map(|mode| [12.0, -15.0, 20.0, 30.0].map(|degrees| (mode, degrees)))
    {
        let turned = Vec3::Z * degrees;
        let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, turned);
        stage.app.world_mut().resource_mut::<Robot>().mode = mode;
        let facts = grip_facts(close(&mut stage));
        assert_eq!(facts, made(), "{degrees}°, {mode:?}");
        let opening = stage.robot().joint(RobotJoint::gripper(ARM)).position;
        assert!(opening < 1.05, "{degrees}°, {mode:?}: {opening}");
        let left = stage.place("thing").rotation.to_euler(EulerRot::ZYX).0;
        // Friction may hold back the last few degrees.
        assert!(left.abs() < 0.12, "{degrees}°, {mode:?}: {left}");
    }
}

#[test]
fn a_wedged_object_is_refused_by_the_angle_of_figure_11() {
    let turned = Vec3::Z * 20.0;
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, turned);
    // Wedged between two walls.
    let frame = Pose::from_degrees(Vec3::new(3.0, -2.0, 0.5), turned);
    for (id, side) in [("one", 1.0), ("other", -1.0)] {
        let wall = block(Vec3::new(1.0, 0.4, 1.0));
        let place = frame * Pose::at(Vec3::Y * side * 0.705);
        stage.put(id, wall, 0.0, place);
    }
    stage.app.step(5);
    let facts = grip_facts(close(&mut stage));
    assert!(
        matches!(facts[..], [SimFact::Robot(RobotFact::GripRefused { angle, .. })] if angle > STEEPEST_GRIP),
        "{facts:?}"
    );
    assert!(stage.robot().limb(ARM).holds.is_empty());
}

#[test]
fn a_held_object_is_put_down_though_the_arm_goes_a_little_too_deep() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    assert_eq!(grip_facts(close(&mut stage)), made());
    let hand = stage.robot().limb(ARM).end_effector.location;
    stage.reach(ARM, hand + Vec3::Z, 0.0);
    stage.reach(ARM, hand + Vec3::NEG_Z * 0.02, 0.0);
    let reached = stage.robot().limb(ARM).end_effector.location;
    assert!(
        (reached.z - (hand.z - 0.02)).abs() < 1e-3,
        "{reached} {hand}"
    );
    assert_eq!(stage.robot().limb(ARM).blocked_by, None);
    stage.tell(RobotCommand::drive([(
        RobotJoint::gripper(ARM),
        Drive::Toward(2.0),
    )]));
    stage.app.step(120);
    let place = stage.place("thing").location;
    assert!((place.z - 0.5).abs() < 0.01, "{place}");
    assert!(
        (place - Vec3::new(3.0, -2.0, 0.5)).length() < 0.05,
        "{place}"
    );
}

#[test]
fn round_things_and_composites_are_held() {
    let ball = Shape::Sphere {
        radius: 0.5,
        color: Rgb::GRAY,
    };
    let cylinder = Shape::Cylinder {
        radius: 0.4,
        yspan: 1.0,
        color: Rgb::GRAY,
    };
    let hammer = Shape::Composite {
        parts: vec![
            Part {
                pointable: false,
                id: String::new(),
                pose: Pose::IDENTITY,
                shape: block(Vec3::new(0.6, 2.0, 0.6)),
            },
            Part {
                pointable: false,
                id: String::new(),
                pose: Pose::at(Vec3::new(0.0, 1.2, 0.0)),
                shape: block(Vec3::new(1.8, 0.6, 0.6)),
            },
        ],
    };
    let things = [
        ("ball", ball, 0.5, Vec3::ZERO),
        ("lying cylinder", cylinder.clone(), 0.4, Vec3::ZERO),
        (
            "cylinder along the opening",
            cylinder.clone(),
            0.4,
            Vec3::Z * 90.0,
        ),
        ("standing cylinder", cylinder, 0.5, Vec3::X * 90.0),
        ("composite", hammer, 0.3, Vec3::ZERO),
    ];
    for (name, shape, z, degrees) in things {
        let mut stage = gripper_around(shape, 1.0, Vec3::Z * z, degrees);
        assert_eq!(grip_facts(close(&mut stage)), made(), "{name}");
    }
}

#[test]
fn two_blocks_are_held_at_once_and_let_go_of_together() {
    let mut stage = Stage::new();
    stage.reach(ARM, Vec3::new(3.0, -2.0, 1.2), 0.0);
    for (id, z) in [("lower", 0.25), ("upper", 0.75)] {
        let shape = block(Vec3::new(1.0, 0.5, 0.5));
        stage.put(id, shape, 1.0, Pose::at(Vec3::new(3.0, -2.0, z)));
    }
    stage.app.step(5);
    let facts = grip_facts(close(&mut stage));
    assert_eq!(facts.len(), 2, "{facts:?}");
    assert_eq!(stage.robot().limb(ARM).holds.len(), 2);
    stage.tell(RobotCommand::drive([(
        RobotJoint::gripper(ARM),
        Drive::Velocity(1.0),
    )]));
    assert_eq!(grip_facts(stage.facts_of(2)).len(), 2);
    assert!(stage.robot().limb(ARM).holds.is_empty());
}

/// A gripper around a block as wide as it opens.
fn around_wide_block(mut stage: Stage) -> Stage {
    let place = Vec3::new(3.0, -2.0, 1.0);
    let pose = Pose::from_degrees(place, Vec3::NEG_Z * 15.0);
    stage.put("thing", block(Vec3::splat(2.0)), 1.0, pose);
    stage.app.step(30);
    for z in [3.5, 2.8, 2.2, 1.5] {
        stage.reach(ARM, place.with_z(z), -15.0);
    }
    stage
}

#[test]
fn a_block_as_wide_as_the_gripper_is_taken_carried_and_put_down() {
    for mode in [RobotMode::Kinematic, RobotMode::Dynamic] {
        let mut stage = around_wide_block(Stage::in_mode(mode));
        let found = stage.place("thing").location;
        let away = (found - Vec3::new(3.0, -2.0, 1.0)).length();
        assert!(away < 0.05, "{mode:?}: {found}");
        assert_eq!(grip_facts(close(&mut stage)), made(), "{mode:?}");
        stage.reach(ARM, Vec3::new(3.0, -2.0, 3.0), -15.0);
        stage.reach(ARM, Vec3::new(4.0, -1.0, 3.0), 0.0);
        // A little above the table, which would stop the arm.
        stage.reach(ARM, Vec3::new(4.0, -1.0, 1.7), 0.0);
        stage.reach(ARM, Vec3::new(4.0, -1.0, 1.53), 0.0);
        let put = stage.place("thing").location.with_z(1.0);

        stage.tell(RobotCommand::drive([(
            RobotJoint::gripper(ARM),
            Drive::Toward(2.0),
        )]));
        let released = SimFact::Robot(RobotFact::GripReleased {
            arm: ARM.name(),
            id: "thing".into(),
        });
        assert_eq!(grip_facts(stage.facts_of(60)), [released], "{mode:?}");
        let away = (stage.place("thing").location - put).length();
        assert!(away < 0.005, "{mode:?}: {away}");
        for z in [2.2, 2.8, 4.0] {
            stage.reach(ARM, Vec3::new(4.0, -1.0, z), 0.0);
        }
        let away = (stage.place("thing").location - put).length();
        // Arms with masses swing a little on their way up, and the fingers leave no more room than that.
        let most = if mode == RobotMode::Dynamic {
            0.02
        } else {
            0.005
        };
        assert!(away < most, "{mode:?}: {away}");
        assert!(stage.robot().limb(ARM).holds.is_empty(), "{mode:?}");
    }
}

#[test]
fn every_order_to_open_releases_an_object_as_wide_as_the_gripper() {
    for order in [
        Drive::Velocity(0.01),
        Drive::Toward(2.0),
        Drive::Position(2.0),
    ] {
        let mut stage = around_wide_block(Stage::new());
        close(&mut stage);
        assert_eq!(stage.robot().limb(ARM).holds.len(), 1);
        let gripper = RobotJoint::gripper(ARM);
        stage.tell(RobotCommand::drive([(gripper, order)]));
        stage.app.step(1);
        assert!(stage.robot().limb(ARM).holds.is_empty(), "{order:?}");
    }
}

#[test]
fn an_order_to_close_or_stay_releases_nothing() {
    for order in [
        Drive::Velocity(0.0),
        Drive::Velocity(-1.0),
        Drive::Toward(0.5),
    ] {
        let mut stage = around_wide_block(Stage::new());
        close(&mut stage);
        let gripper = RobotJoint::gripper(ARM);
        stage.tell(RobotCommand::drive([(gripper, order)]));
        stage.app.step(10);
        assert_eq!(stage.robot().limb(ARM).holds.len(), 1, "{order:?}");
    }
}

#[test]
fn a_gripper_that_cannot_open_releases_all_the_same() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    close(&mut stage);
    for (id, x) in [("left wall", 1.82), ("right wall", 4.18)] {
        let place = Pose::at(Vec3::new(x, -2.0, 0.5));
        stage.put(id, unit_block(), 0.0, place);
    }
    stage.app.step(5);
    let gripper = RobotJoint::gripper(ARM);
    stage.tell(RobotCommand::drive([(gripper, Drive::Toward(2.0))]));
    stage.app.step(60);
    assert!(stage.robot().joint(gripper).position < 1.1);
    assert!(stage.robot().limb(ARM).holds.is_empty());
}

#[test]
fn a_fixed_object_is_not_held_and_stops_the_fingers() {
    let mut stage = gripper_around(unit_block(), 0.0, Vec3::Z * 0.5, Vec3::ZERO);
    assert!(grip_facts(close(&mut stage)).is_empty());
    let opening = stage.robot().joint(RobotJoint::gripper(ARM)).position;
    assert!((1.0..1.05).contains(&opening), "{opening}");
}

#[test]
fn a_hand_takes_an_object_out_of_a_gripper() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    close(&mut stage);
    stage.tell(HandCommand::Grasp {
        hand: tabletop_core::Hand::Left,
        object: "thing".into(),
    });
    let facts = grip_facts(stage.facts_of(2));
    assert!(
        matches!(facts[..], [SimFact::Robot(RobotFact::GripReleased { .. })]),
        "{facts:?}"
    );
    assert!(stage.robot().limb(ARM).holds.is_empty());
}

#[test]
fn hiding_the_robot_releases_held_objects() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    close(&mut stage);
    stage.reach(ARM, Vec3::new(3.0, -2.0, 2.0), 0.0);
    let cause = stage.tell(RobotCommand::Show(false));
    let facts = stage.facts_of(120);
    assert!(facts.contains(&SimFact::Robot(RobotFact::Shown {
        cause,
        shown: false
    })));
    assert!((stage.place("thing").location.z - 0.5).abs() < 0.02);
}

#[test]
fn a_held_object_stays_when_the_table_is_cleared() {
    let mut stage = gripper_around(unit_block(), 1.0, Vec3::Z * 0.5, Vec3::ZERO);
    close(&mut stage);
    stage.tell(SceneCommand::Clear);
    stage.app.step(5);
    assert_eq!(stage.robot().limb(ARM).holds.len(), 1);
    let robot = stage.app.world().resource::<Robot>().clone();
    let touched: Vec<_> = robot.contacts.iter().map(|contact| contact.thing).collect();
    assert_eq!(touched, [robot.limb(ARM).holds[0]; 2]);
}

#[test]
fn a_lid_is_pulled_open_by_its_handle() {
    let mut stage = Stage::new();
    let chest = LidBoxSpec {
        id: "chest".into(),
        pose: Pose::at(Vec3::new(3.5, -2.0, 0.75)),
        span: Vec3::new(3.0, 2.0, 1.5),
        thickness: 0.2,
        box_mass: 20.0,
        lid_mass: 0.3,
        color: Rgb::GRAY,
        handle_span: Vec3::new(0.8, 0.6, 0.6),
        handle_thickness: 0.1,
        handle_color: Rgb::GRAY,
        descriptions: Vec::new(),
    };
    let scene = SceneSpec {
        items: vec![SceneItem::LidBox(chest)],
        ..default()
    };
    stage.tell(SceneCommand::Set(Box::new(scene)));
    stage.app.step(60);
    let ids: Vec<String> = {
        let index = stage.app.world().resource::<ObjectIndex>();
        index.ids().map(str::to_owned).collect()
    };
    let lid = ids.iter().find(|id| id.contains("lid")).unwrap().clone();
    let before = stage.place(&lid).location;
    stage.reach(ARM, Vec3::new(before.x, -2.0, 3.6), 0.0);
    stage.reach(ARM, Vec3::new(before.x, -2.0, 2.65), 0.0);
    let facts = grip_facts(close(&mut stage));
    assert!(
        matches!(&facts[..], [SimFact::Robot(RobotFact::GripMade { id, .. })] if *id == lid),
        "{facts:?}"
    );
    stage.reach(ARM, Vec3::new(before.x - 1.0, -2.0, 2.65), 0.0);
    stage.app.step(30);
    for contact in &stage.robot().contacts {
        assert_eq!(contact.impulse, 0.0, "a grip is no force: {contact:?}");
    }
    assert_eq!(stage.robot().contacts.len(), 2);
    let pulled = before.x - stage.place(&lid).location.x;
    assert!((0.9..1.1).contains(&pulled), "{pulled}");
    let rose = stage.place(&lid).location.z - before.z;
    assert!(rose.abs() < 0.1, "{rose}");
}
