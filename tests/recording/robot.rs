//! Recordings of the robot's acts.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop::{core::Drive, prelude::*, robot::RobotLink};

use crate::demonstration::{Demonstration, assert_replays};

#[test]
fn what_the_robot_did_before_and_in_a_recording_is_done_again() {
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
