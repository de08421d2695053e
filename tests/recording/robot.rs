//! Recordings of what the robot does.

use tabletop::{core::Drive, prelude::*};

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
