//! A recording for tests.

use std::path::Path;

use bevy::prelude::*;
use tabletop_core::prelude::*;
use tabletop_geometry::{Pose, Rgb};
use tabletop_recorder::RecorderPlugin;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};

/// Records that a hand puts a red block on a blue one.
pub(crate) fn record(folder: &Path) {
    let recorder = RecorderPlugin {
        folder: folder.to_owned(),
        ..default()
    };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
    let block = |id: &str, x: f32, color| {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color,
        };
        let pose = Pose::at(Vec3::new(x, -2.0, 0.5));
        SceneItem::Object(ObjectSpec::new(id, pose, 1.0, shape))
    };
    let scene = SceneSpec {
        items: vec![block("Red", 2.0, Rgb::RED), block("Blue", -2.0, Rgb::BLUE)],
        ..default()
    };
    let hand = Hand::Right;
    let to = |x, z| HandCommand::MoveTo {
        hand,
        location: Vec3::new(x, -2.0, z),
    };
    let grasp = HandCommand::Grasp {
        hand,
        object: "Red".into(),
    };
    let mut act = |command: SimCommand, ticks: u64| {
        app.world_mut().write_command(command);
        app.step(ticks);
    };
    act(SceneCommand::Set(Box::new(scene)).into(), 30);
    act(RecordingCommand::Start.into(), 30);
    act(grasp.into(), 10);
    act(to(2.0, 3.0).into(), 20);
    act(to(-2.0, 3.0).into(), 20);
    act(to(-2.0, 1.5).into(), 20);
    act(HandCommand::Release(hand).into(), 40);
    act(RecordingCommand::Finish.into(), 1);
}
