//! Recordings that were made with other settings.

use bevy::prelude::*;
use tabletop::{physics::PhysicsSettings, prelude::*};

use crate::demonstration::{Demonstration, assert_replays};

#[test]
fn a_replay_has_the_settings_and_the_camera_of_its_recording() {
    let physics = PhysicsSettings {
        gravity: 16.2,
        friction: 0.1,
        ..default()
    };
    let mut moon = Demonstration::with_physics("moon", physics);
    let hand = Hand::Left;
    let object = "RedBlock".to_owned();
    moon.act(&[
        (
            vec![SimCommand::Scene(SceneCommand::Load(
                "tablesetup/default.xml".into(),
            ))],
            30,
        ),
        (
            vec![SimCommand::Hand(HandCommand::Grasp { hand, object })],
            1,
        ),
        (
            vec![SimCommand::Hand(HandCommand::MoveTo {
                hand,
                location: Vec3::new(-1.2, 0.3, 6.0),
            })],
            40,
        ),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 10),
        (vec![SimCommand::Hand(HandCommand::Release(hand))], 120),
        (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
    ]);
    assert_replays(&moon.folder);
}
