//! A recording that all tests export.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use bevy::prelude::*;
use tabletop_core::prelude::*;
use tabletop_export::{EpisodeSelection, TrainingEpisode};
use tabletop_recorder::RecorderPlugin;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};
use tabletop_storage::{Patience, Storage};

/// The folder in which a test writes; remains of an earlier run are removed.
pub fn fresh(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _not_there = fs::remove_dir_all(&path);
    let _not_there = fs::remove_file(&path);
    path
}

/// The file system, without waiting for others.
pub fn alone() -> Storage {
    Storage::default().with_patience(Patience::None)
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

#[test]
fn an_episode_has_a_frame_every_quarter_of_a_second() {
    let episode = episode();
    assert_eq!(episode.fps, 4);
    let steps: Vec<_> = episode
        .ticks
        .windows(2)
        .map(|two| two[1].0 - two[0].0)
        .collect();
    let (last, others) = steps.split_last().unwrap();
    assert!(others.iter().all(|step| *step == 15), "{steps:?}");
    assert!(*last <= 15);
    assert_eq!(episode.cameras.len(), 1);
    assert_eq!(episode.cameras[0].images.len(), episode.len());
    assert_eq!(episode.state.frames().len(), episode.len());
    assert_eq!(episode.action.frames().len(), episode.len());
}

#[test]
fn the_actions_of_a_hand_lead_from_place_to_place() {
    let episode = episode();
    let column = |names: &[String], name: &str| names.iter().position(|it| it == name).unwrap();
    let x = column(&episode.state.names, "right_hand.x");
    let dx = column(&episode.action.names, "right_hand.dx");
    let grip = column(&episode.action.names, "right_hand.grip");
    let states: Vec<_> = episode.state.frames().map(|frame| frame[x]).collect();
    let actions: Vec<_> = episode.action.frames().collect();
    for (two, action) in states.windows(2).zip(&actions) {
        assert!((two[0] + action[dx] - two[1]).abs() < 1e-5);
    }
    assert!(actions.iter().any(|action| action[grip] == 1.0));
    assert_eq!(actions.last().unwrap()[grip], 0.0);
}

#[test]
fn the_task_is_told_as_a_whole_and_in_parts() {
    let episode = episode();
    assert_eq!(episode.task, "Put the red block on the green block.");
    let parts: Vec<_> = episode
        .subtasks
        .iter()
        .map(|part| part.sentence.as_str())
        .collect();
    assert_eq!(
        parts,
        ["pick up the red block", "put it on the green block"]
    );
    assert_eq!(episode.subtasks[0].frame, 0);
    assert!(episode.subtasks[1].frame > 0);
    assert!(!episode.paraphrases.is_empty());
    assert!(!episode.paraphrases.contains(&episode.task));
}
