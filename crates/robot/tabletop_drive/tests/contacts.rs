//! Contacts of the robot: their places and impulses.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use kit::{Stage, block};
use tabletop_core::{
    Arm, Drive, ObjectIndex, Obstacle, RobotCommand, RobotContact, RobotJoint, StepApp,
    TICK_SECONDS, Table,
};
use tabletop_geometry::{Pose, Twist};

const ARM: Arm = Arm::Right;

const RIGHT_FINGER: &str = "right-gripper-right-finger";

const GRAVITY: f32 = 98.1;

fn drive(stage: &mut Stage, joint: RobotJoint, drive: Drive) {
    stage.tell(RobotCommand::drive([(joint, drive)]));
}

fn object(stage: &Stage, id: &str) -> Entity {
    stage.app.world().resource::<ObjectIndex>().get(id).unwrap()
}

/// Names of the bodies in contact.
fn bodies(stage: &Stage) -> Vec<&str> {
    let contacts = stage.robot().contacts.iter();
    contacts.map(|contact| contact.body.as_str()).collect()
}

/// The point of a contact in the frame of an object.
fn on(stage: &Stage, id: &str, contact: &RobotContact) -> Vec3 {
    stage.place(id).inverse() * contact.point
}

/// A closed right gripper beside an object on the table that it is sent through.
fn push(mut stage: Stage, mass: f32) -> Stage {
    stage.reach(ARM, Vec3::new(2.0, -3.0, 0.9), 0.0);
    drive(&mut stage, RobotJoint::gripper(ARM), Drive::Position(0.2));
    let place = Pose::at(Vec3::new(4.0, -3.0, 0.5));
    stage.put("thing", block(Vec3::ONE), mass, place);
    let pose = Pose::at(Vec3::new(5.0, -3.0, 0.9));
    stage.tell(RobotCommand::ReachTo {
        arm: ARM.name(),
        pose,
    });
    stage
}

#[test]
fn at_home_it_touches_nothing() {
    let mut stage = Stage::new();
    let place = Pose::at(Vec3::new(3.0, 0.0, 0.5));
    stage.put("thing", block(Vec3::ONE), 1.0, place);
    stage.app.step(10);
    assert_eq!(stage.robot().contacts, []);
}

#[test]
fn a_finger_that_pushes_a_block_feels_its_inertia_and_its_friction() {
    for stage in [Stage::new(), Stage::dynamic()] {
        let mass = 1.0;
        let mut stage = push(stage, mass);
        stage.app.step(1);
        let thing = object(&stage, "thing");
        let velocity = |stage: &Stage| stage.app.world().get::<Twist>(thing).unwrap().linear;
        let mut impulses = Vec::new();
        let mut before = velocity(&stage);
        for _ in 0..100 {
            stage.app.step(1);
            let after = velocity(&stage);
            let momentum = mass * (after - std::mem::replace(&mut before, after)).x;
            let [contact] = &stage.robot().contacts[..] else {
                assert_eq!(stage.robot().contacts, []);
                continue;
            };
            assert_eq!(
                (contact.body.as_str(), contact.thing),
                (RIGHT_FINGER, thing)
            );
            let point = on(&stage, "thing", contact);
            assert!((point.x + 0.5).abs() < 1e-3, "{point}");
            assert!(point.abs().max_element() < 0.5 + 1e-3, "{point}");
            impulses.push(contact.impulse);
            if contact.impulse == 0.0 {
                continue;
            }
            // The table takes a quarter of the force on it: the block's weight, and friction with the finger.
            let friction = contact.impulse - momentum;
            let of_weight = 0.25 * mass * GRAVITY * TICK_SECONDS;
            let of_finger = 0.25 * 0.5 * contact.impulse;
            assert!(
                (friction - of_weight).abs() < of_finger + 0.05,
                "{contact:?} {momentum}"
            );
        }
        assert_eq!(impulses[0], 0.0, "it is reached before it is pushed");
        let hardest = impulses.iter().copied().fold(0.0, f32::max);
        assert!(hardest > 2.0, "{impulses:?}");
    }
}

#[test]
fn a_link_feels_the_weight_of_its_load() {
    let mut stage = Stage::new();
    let mass = 2.0;
    let plate = block(Vec3::new(1.0, 1.0, 0.2));
    stage.put("plate", plate, mass, Pose::at(Vec3::new(4.4, -5.58, 6.7)));
    stage.app.step(10);
    let ticks = 40;
    let mut pressure = 0.0;
    for _ in 0..ticks {
        stage.app.step(1);
        assert_eq!(bodies(&stage), ["right_upper_forearm"]);
        let contact = &stage.robot().contacts[0];
        let point = on(&stage, "plate", contact);
        assert!((point - Vec3::NEG_Z * 0.1).length() < 0.1, "{point}");
        pressure += contact.impulse;
    }
    let weight = mass * GRAVITY * TICK_SECONDS;
    let mean = pressure / ticks as f32;
    assert!((mean - weight).abs() < 0.05 * weight, "{mean} {weight}");
}

#[test]
fn both_fingers_touch_held_objects_where_they_hold_them() {
    let mut stage = Stage::new();
    stage.reach(ARM, Vec3::new(3.0, -2.0, 0.85), 0.0);
    for (id, height) in [("upper", 0.75), ("lower", 0.25)] {
        let place = Pose::at(Vec3::new(3.0, -2.0, height));
        stage.put(id, block(Vec3::new(1.0, 1.0, 0.5)), 0.5, place);
    }
    drive(&mut stage, RobotJoint::gripper(ARM), Drive::Toward(0.0));
    stage.app.step(120);
    stage.reach(ARM, Vec3::new(4.0, -1.0, 3.0), 40.0);
    let held = ["upper", "lower"].map(|id| object(&stage, id));
    let left = "right-gripper-left-finger";
    let expected = [left, RIGHT_FINGER].map(|finger| held.map(|thing| (finger, thing)));
    let contacts = &stage.robot().contacts;
    let touched: Vec<_> = contacts
        .iter()
        .map(|contact| (contact.body.as_str(), contact.thing))
        .collect();
    assert_eq!(touched, expected.concat());
    for (contact, (id, x)) in contacts.iter().zip([
        ("upper", -0.5),
        ("lower", -0.5),
        ("upper", 0.5),
        ("lower", 0.5),
    ]) {
        let point = on(&stage, id, contact);
        assert!((point.x - x).abs() < 0.01, "{id} {point}");
        assert!(point.y.abs() < 0.05 && point.z.abs() < 0.25, "{id} {point}");
        assert_eq!(contact.impulse, 0.0);
    }
}

#[test]
fn an_arm_touches_the_object_that_stops_it() {
    for stage in [Stage::new(), Stage::dynamic()] {
        let mut stage = push(stage, 0.0);
        stage.app.step(200);
        assert_eq!(
            stage.robot().limb(ARM).blocked_by,
            Some(Obstacle::Object("thing".into()))
        );
        assert_eq!(bodies(&stage), [RIGHT_FINGER]);
        let contact = &stage.robot().contacts[0];
        assert_eq!(
            (contact.thing, contact.impulse),
            (object(&stage, "thing"), 0.0)
        );
        let point = on(&stage, "thing", contact);
        assert!((point.x + 0.5).abs() < 1e-3, "{point}");
    }
}

#[test]
fn the_table_is_touched_until_the_arm_leaves_it_or_the_robot_is_hidden() {
    let mut stage = Stage::new();
    let world = stage.app.world_mut();
    let mut tables = world.query_filtered::<Entity, With<Table>>();
    let table = tables.single(world).unwrap();
    stage.reach(ARM, Vec3::new(3.0, -3.0, 1.5), 0.0);
    let lower = |stage: &mut Stage, velocity| {
        for _ in 0..60 {
            drive(stage, RobotJoint::RightS1, Drive::Velocity(velocity));
            stage.app.step(1);
        }
    };
    lower(&mut stage, 1.0);
    assert!(!stage.robot().contacts.is_empty());
    for contact in &stage.robot().contacts {
        assert!(contact.body.starts_with("right-gripper-"), "{contact:?}");
        assert_eq!((contact.thing, contact.impulse), (table, 0.0));
        assert!(contact.point.z.abs() < 1e-4, "{contact:?}");
    }
    stage.tell(RobotCommand::Show(false));
    stage.app.step(1);
    assert_eq!(stage.robot().contacts, []);
    stage.tell(RobotCommand::Show(true));
    stage.app.step(1);
    assert!(!stage.robot().contacts.is_empty());
    lower(&mut stage, -0.1);
    assert_eq!(stage.robot().contacts, []);
}
