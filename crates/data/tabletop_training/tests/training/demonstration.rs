//! A recording that all tests export.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use bevy::prelude::*;
use tabletop_core::prelude::*;
use tabletop_recorder::RecorderPlugin;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};
use tabletop_training::{EpisodeSelection, TrainingEpisode};

/// The folder in which a test writes; remains of an earlier run are removed.
pub fn fresh(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _not_there = fs::remove_dir_all(&path);
    let _not_there = fs::remove_file(&path);
    path
}

/// A recording in which the right hand puts a red block onto a green one.
pub fn recording() -> &'static Path {
    static RECORDING: LazyLock<PathBuf> = LazyLock::new(|| {
        let folder = fresh("demonstration");
        let recorder = RecorderPlugin {
            folder: folder.clone(),
            ..default()
        };
        let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
        let block = |id: &str, x: f32, color| {
            let shape = Shape::Block {
                span: Vec3::ONE,
                color,
            };
            let pose = Pose::at(Vec3::new(x, 0.0, 0.5));
            SceneItem::Object(ObjectSpec::new(id, pose, 1.0, shape))
        };
        let scene = SceneSpec {
            items: vec![
                block("Red", 2.0, Rgb::RED),
                block("Green", -2.0, Rgb::GREEN),
            ],
            ..default()
        };
        let hand = Hand::Right;
        let to = |x, z| HandCommand::MoveTo {
            hand,
            location: Vec3::new(x, 0.0, z),
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
        act(to(-2.0, 1.51).into(), 20);
        act(HandCommand::Release(hand).into(), 40);
        act(RecordingCommand::Finish.into(), 1);
        folder
    });
    &RECORDING
}

/// The recording as an episode.
pub fn episode() -> TrainingEpisode {
    TrainingEpisode::read(recording(), &EpisodeSelection::default()).unwrap()
}
