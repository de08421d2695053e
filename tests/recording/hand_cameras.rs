//! Recordings with the pictures of Baxter's hand cameras.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop::{
    core::{Drive, HeadCamera, Light},
    headless_app_with,
    prelude::*,
    recorder::{Channels, Durability, HandPictures, RecorderPlugin, RecordingReader},
    replay::Replay,
    storage::InnerFile,
};

use crate::demonstration::{Demonstration, assert_replays, fresh_folder};

fn demonstration(name: &str) -> Demonstration {
    let folder = fresh_folder(name);
    let recorder = RecorderPlugin {
        folder: folder.clone(),
        hand_pictures: HandPictures::OfAll,
        ..default()
    };
    let app = headless_app_with(TabletopSimPlugins.build().set(recorder));
    Demonstration { app, folder }
}

fn load() -> SimCommand {
    SceneCommand::Load("tablesetup/default.xml".into()).into()
}

fn drive(joint: RobotJoint, position: f64) -> SimCommand {
    RobotCommand::drive([(joint, Drive::Toward(position))]).into()
}

fn names_in(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    entries.map(|entry| name(entry.unwrap())).collect()
}

/// Records a motion of the left arm, and a hand that moves a block.
fn recorded(name: &str) -> PathBuf {
    let mut demonstration = demonstration(name);
    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    demonstration.act(&[
        (vec![load(), RobotCommand::Show(true).into()], 20),
        (vec![RecordingCommand::Start.into()], 10),
        (vec![drive(RobotJoint::LeftE1, 2.0)], 40),
        (vec![HandCommand::Grasp { hand, object }.into()], 30),
        (vec![HandCommand::Release(hand).into()], 30),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    demonstration.folder
}

#[test]
fn they_are_replayed_to_the_byte() {
    let folder = recorded("hand_cameras");
    let recording = RecordingReader::open(&folder).unwrap();
    let segments = recording.segments().unwrap();
    // Frames 1 to 3 are in it because the arm moves.
    let numbers: Vec<_> = segments[0].frames.iter().map(|it| it.number).collect();
    assert_eq!(numbers[..3], [0, 1, 2]);
    let [first, third] = [0, 2].map(|frame: usize| &segments[0].frames[frame].hand_pictures);
    let bytes = |picture: &InnerFile| picture.read(1 << 20).unwrap();
    let is_same = |camera| bytes(&first[camera]) == bytes(&third[camera]);
    assert!(!is_same("left_hand_camera"), "the left hand has moved");
    assert!(is_same("right_hand_camera"), "the right hand has not");
    assert_replays(&folder);
}

#[test]
fn an_undone_segment_leaves_none() {
    let mut undone = demonstration("hand_cameras_undone");
    let mut plain = demonstration("hand_cameras_not_undone");
    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    for demonstration in [&mut undone, &mut plain] {
        demonstration.act(&[
            (vec![load(), RobotCommand::Show(true).into()], 20),
            (vec![RecordingCommand::Start.into()], 10),
            (vec![drive(RobotJoint::LeftE1, 2.0)], 20),
        ]);
    }
    undone.act(&[
        (vec![HandCommand::Grasp { hand, object }.into()], 10),
        (vec![drive(RobotJoint::RightE1, 2.0)], 30),
        (vec![HistoryCommand::Undo.into()], 1),
    ]);
    let now = undone.app.world().resource::<SimTick>().0;
    undone.app.step(200 - now);
    let now = plain.app.world().resource::<SimTick>().0;
    plain.app.step(200 - now);
    for demonstration in [&mut undone, &mut plain] {
        demonstration.tick(&[RecordingCommand::Finish.into()]);
    }
    assert_eq!(names_in(&undone.folder), names_in(&plain.folder));
    let [one, other] = [&undone, &plain].map(|it| it.folder.join("0"));
    assert_eq!(names_in(&one), names_in(&other));
    for name in names_in(&one) {
        let [one, other] = [&one, &other].map(|it| fs::read(it.join(&name)).unwrap());
        assert!(one == other, "{name}");
    }
    assert_replays(&undone.folder);
}

#[test]
fn they_are_added_to_a_recording_that_has_none_with_all_channels() {
    let mut plain = Demonstration::new("hand_cameras_added");
    plain.act(&[
        (vec![load(), RobotCommand::Show(true).into()], 20),
        (vec![RecordingCommand::Start.into()], 10),
        (vec![drive(RobotJoint::LeftE1, 2.0)], 40),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    let replay = Replay::read(&plain.folder).unwrap();
    assert_eq!(replay.hand_cameras(), []);
    let added = fresh_folder("hand_cameras_added_to");
    let recorder = RecorderPlugin {
        folder: added.clone(),
        hand_pictures: HandPictures::OfAll,
        channels: Channels {
            depth: true,
            ids: true,
        },
        durability: Durability::None,
        ..default()
    };
    replay.record(recorder, replay.camera()).unwrap();
    let names = names_in(&added.join("0"));
    for name in [
        "2.png",
        "2.depth.png",
        "2.left_hand_camera.png",
        "2.left_hand_camera.depth.png",
        "2.right_hand_camera.ids.png",
    ] {
        assert!(names.contains(name), "{name}: {names:?}");
    }
}

#[test]
fn a_camera_on_a_link_that_the_robot_lacks_is_refused() {
    let folder = recorded("hand_cameras_lost");
    let path = folder.join("session.jsonl");
    let log = fs::read_to_string(&path).unwrap();
    let link = "\"link\":\"left_hand_camera\"";
    assert!(log.contains(link));
    fs::write(&path, log.replacen(link, "\"link\":\"tail\"", 1)).unwrap();
    let error = Replay::read(&folder).unwrap_err().to_string();
    let expected = "hand_cameras: left_hand_camera: the robot has no link tail";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn the_light_of_a_recording_is_that_of_its_replay() {
    let mut dim = demonstration("hand_cameras_dim");
    let light = Light {
        color: Vec3::new(0.5, 0.4, 0.3),
        ..default()
    };
    dim.app.world_mut().resource_mut::<HeadCamera>().light = light;
    dim.act(&[
        (vec![load(), RobotCommand::Show(true).into()], 20),
        (vec![RecordingCommand::Start.into()], 10),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    let replay = Replay::read(&dim.folder).unwrap();
    assert_eq!(replay.camera().light, light);
    assert_replays(&dim.folder);
}
