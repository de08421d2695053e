//! How much memory undo takes.

use bevy::prelude::*;
use tabletop::{core::History, prelude::*};

use crate::demonstration::Demonstration;

/// Towers of five blocks.
const BLOCKS: usize = 300;

/// Largest size of a segment, in bytes.
const MOST_BYTES: usize = 800_000;

#[test]
fn a_segment_shares_unchanged_state() {
    let color = Rgb::GRAY;
    let span = Vec3::ONE / 2.0;
    let blocks = (0..BLOCKS).map(|number| {
        let (tower, storey) = (number / 5, number % 5);
        let [x, y] = [tower % 10, tower / 10].map(|place| place as f32);
        let at = Vec3::new(x * 1.8 - 8.1, y * 1.8 - 4.5, storey as f32 / 2.0 + 0.25);
        let shape = Shape::Block { span, color };
        let block = ObjectSpec::new(format!("block{number}"), Pose::at(at), 1.0, shape);
        SceneItem::Object(block)
    });
    let scene = SceneSpec {
        items: blocks.collect(),
        ..default()
    };
    let mut demonstration = Demonstration::new("history_size");
    demonstration.tick(&[SceneCommand::Set(Box::new(scene)).into()]);
    demonstration.act(&[(Vec::new(), 240), (vec![RecordingCommand::Start.into()], 1)]);
    let bytes = |demonstration: &Demonstration| {
        let history = demonstration.app.world().resource::<History>();
        (history.undoable, history.bytes)
    };
    let hand = Hand::Right;
    let mut before = bytes(&demonstration);
    let mut segments = Vec::new();
    for number in [4, 9, 14] {
        let object = format!("block{number}");
        let offset = Vec3::Z * 2.0;
        demonstration.act(&[
            (vec![HandCommand::Grasp { hand, object }.into()], 1),
            (vec![HandCommand::MoveBy { hand, offset }.into()], 30),
            (vec![HandCommand::Release(hand).into()], 60),
        ]);
        let after = bytes(&demonstration);
        segments.push((after.1 - before.1) / (after.0 - before.0));
        before = after;
    }
    let later = segments[1..].iter().max().unwrap();
    assert!(*later < MOST_BYTES, "{segments:?}");
}
