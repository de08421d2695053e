//! A recording ends with the poses of all objects.

use std::fs;

use bevy::prelude::*;
use tabletop::prelude::*;

use crate::demonstration::{Demonstration, assert_replays};

#[test]
fn a_block_that_was_let_fall_a_little_lies_where_it_came_to_rest() {
    let mut demonstration = Demonstration::new("ending");
    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    let location = Vec3::new(0.0, 3.0, 1.02);
    demonstration.act(&[
        (
            vec![SimCommand::Scene(SceneCommand::Load(
                "tablesetup/default.xml".into(),
            ))],
            60,
        ),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 10),
        (
            vec![SimCommand::Hand(HandCommand::Grasp { hand, object })],
            1,
        ),
        (
            vec![SimCommand::Hand(HandCommand::MoveTo { hand, location })],
            30,
        ),
        (vec![SimCommand::Hand(HandCommand::Release(hand))], 5),
        (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
    ]);
    let text = fs::read_to_string(demonstration.folder.join("2.txt")).unwrap();
    let mut lines = text.lines();
    let last = lines.rfind(|line| line.contains(",move,RedBlock,"));
    let fields: Vec<_> = last.unwrap().split(',').collect();
    let height: f32 = fields[5].parse().unwrap();
    let block = demonstration.app.world().resource::<ObjectIndex>();
    let block = block.get("RedBlock").unwrap();
    let place = demonstration.app.world().get::<Transform>(block).unwrap();
    assert_eq!(height, place.translation.z, "{text}");
    assert!(height < 1.01, "{text}");

    assert_replays(&demonstration.folder);
}
