//! Recordings of the robot's acts.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop::{core::Drive, prelude::*, robot::RobotLink};

use crate::demonstration::{Demonstration, assert_replays};

#[test]
fn the_robots_motion_before_and_in_a_recording_is_replayed() {
    let mut demonstration = Demonstration::new("robot");
    let load = || SimCommand::Scene(SceneCommand::Load("tablesetup/default.xml".into()));
    let drive = |joint, position| {
        SimCommand::Robot(RobotCommand::drive([(joint, Drive::Toward(position))]))
    };
    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    demonstration.act(&[
        (vec![load()], 20),
        (vec![SimCommand::Robot(RobotCommand::Show(true))], 5),
        (vec![drive(RobotJoint::HeadPan, 0.4)], 10),
        (vec![load()], 10),
        (vec![drive(RobotJoint::LeftS1, 0.3)], 20),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 10),
        (vec![drive(RobotJoint::RightE1, 1.0)], 40),
        (
            vec![SimCommand::Hand(HandCommand::Grasp { hand, object })],
            30,
        ),
        (vec![SimCommand::Hand(HandCommand::Release(hand))], 30),
        (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
    ]);
    assert_replays(&demonstration.folder);
}

#[test]
fn links_inside_the_objects_of_a_scene_are_passive_again_after_undo() {
    let mut demonstration = Demonstration::new("passive_again");
    let block = |id: String, at| {
        let shape = Shape::Block {
            span: Vec3::splat(0.8),
            color: Rgb::GRAY,
        };
        SceneItem::Object(ObjectSpec::new(id, Pose::at(at), 1.0, shape))
    };
    let set = |items| SceneCommand::Set(Box::new(SceneSpec { items, ..default() })).into();
    demonstration.act(&[
        (vec![set(Vec::new()), RobotCommand::Show(true).into()], 5),
        (vec![RecordingCommand::Start.into()], 5),
    ]);
    let world = demonstration.app.world_mut();
    let mut links = world.query_filtered::<&Transform, (With<RobotLink>, With<Collider>)>();
    let places = links.iter(world).map(|place| place.translation);
    let high = places.filter(|place| place.z > 1.0).enumerate();
    let mut items: Vec<_> = high.map(|(i, at)| block(format!("in{i}"), at)).collect();
    items.push(block("held".into(), Vec3::new(0.0, 4.0, 0.4)));
    let grasp = HandCommand::Grasp {
        hand: Hand::Left,
        object: "held".into(),
    };
    demonstration.act(&[
        (vec![set(items), grasp.into()], 1),
        (vec![ClockCommand::SetPaused(true).into()], 1),
        (vec![HistoryCommand::Undo.into()], 1),
        (vec![ClockCommand::SetPaused(false).into()], 20),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert_replays(&demonstration.folder);
}

#[test]
fn a_robot_shown_in_a_long_pause_moves_and_is_touched_afterwards() {
    let mut demonstration = Demonstration::new("shown_in_pause");
    let pause = |paused| SimCommand::Clock(ClockCommand::SetPaused(paused));
    let drive = RobotCommand::drive([(RobotJoint::RightE1, Drive::Toward(1.0))]);
    demonstration.act(&[
        (
            vec![SceneCommand::Load("tablesetup/default.xml".into()).into()],
            20,
        ),
        (vec![RecordingCommand::Start.into()], 10),
        (vec![pause(true)], 10),
        (vec![RobotCommand::Show(true).into()], 10),
        (vec![pause(false), drive.into()], 40),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);

    let world = demonstration.app.world_mut();
    let mut sets = world.query::<&RapierRigidBodySet>();
    let mut links =
        world.query_filtered::<(Entity, &Transform), (With<RobotLink>, With<Collider>)>();
    let set = sets.single(world).unwrap();
    for (link, place) in links.iter(world) {
        let body = &set.bodies[set.entity2body()[&link]];
        assert!(body.is_enabled());
        assert_eq!(body.translation(), place.translation);
    }
    assert_replays(&demonstration.folder);
}
