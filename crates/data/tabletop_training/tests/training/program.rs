//! The program that a recording means, among the words for its task.

use bevy::prelude::*;
use tabletop_core::prelude::*;
use tabletop_recorder::RecorderPlugin;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};
use tabletop_training::{EpisodeSelection, TrainingEpisode};

use crate::demonstration::fresh;

/// A recording in which the right hand puts both red blocks onto a plate, and leaves the green one.
fn recorded(name: &str) -> std::path::PathBuf {
    let folder = fresh(name);
    let recorder = RecorderPlugin {
        folder: folder.clone(),
        ..default()
    };
    let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
    let block = |id: &str, at: Vec3, span: Vec3, color| {
        let shape = Shape::Block { span, color };
        SceneItem::Object(ObjectSpec::new(id, Pose::at(at), 1.0, shape))
    };
    let scene = SceneSpec {
        items: vec![
            block("A", Vec3::new(2.0, 0.0, 0.5), Vec3::ONE, Rgb::RED),
            block("B", Vec3::new(4.0, 0.0, 0.5), Vec3::ONE, Rgb::RED),
            block("C", Vec3::new(6.0, 0.0, 0.5), Vec3::ONE, Rgb::GREEN),
            block(
                "Plate",
                Vec3::new(-4.0, 0.0, 0.1),
                Vec3::new(4.0, 4.0, 0.2),
                Rgb::WHITE,
            ),
        ],
        ..default()
    };
    let mut act = |command: SimCommand, ticks: u64| {
        app.world_mut().write_command(command);
        app.step(ticks);
    };
    act(SceneCommand::Set(Box::new(scene)).into(), 30);
    act(RecordingCommand::Start.into(), 30);
    let hand = Hand::Right;
    for (id, from, to) in [("A", 2.0, -5.0), ("B", 4.0, -3.0)] {
        let object = id.to_owned();
        act(HandCommand::Grasp { hand, object }.into(), 10);
        for (x, z) in [(from, 3.0), (to, 3.0), (to, 0.71)] {
            let location = Vec3::new(x, 0.0, z);
            act(HandCommand::MoveTo { hand, location }.into(), 20);
        }
        act(HandCommand::Release(hand).into(), 40);
    }
    act(RecordingCommand::Finish.into(), 1);
    folder
}

const MEANT: &str = "Put every red block on the plate.";

#[test]
fn the_program_is_among_the_words_if_it_is_asked_for() {
    let folder = recorded("program_words");
    let words = |has_program| {
        let selection = EpisodeSelection {
            has_program,
            ..EpisodeSelection::default()
        };
        TrainingEpisode::read(&folder, &selection)
            .unwrap()
            .paraphrases
    };
    assert!(!words(false).iter().any(|text| text == MEANT));
    let with = words(true);
    assert_eq!(with[..with.len() - 1], words(false));
    assert_eq!(with.last().unwrap(), MEANT);
}

#[test]
fn what_is_no_more_than_a_step_has_no_program() {
    let selection = EpisodeSelection {
        has_program: true,
        ..EpisodeSelection::default()
    };
    let folder = crate::demonstration::recording();
    let episode = TrainingEpisode::read(folder, &selection).unwrap();
    assert_eq!(
        episode.paraphrases,
        crate::demonstration::episode().paraphrases
    );
}
