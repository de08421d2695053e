//! The pictures of hand cameras.

use std::{collections::BTreeSet, fs};

use bevy::prelude::{App, default};
use tabletop_core::{
    Hand, HistoryCommand, RecordingCommand, Robot, SimCommand, SimTick, StepApp as _,
    WriteCommand as _,
};
use tabletop_recorder::{Channels, HandPictures, RecorderPlugin, RecordingReader};
use tabletop_storage::InnerFile;

use crate::stage::{Place, app_with, files_in, grasp, run, scene};

fn recorder(place: &Place, hand_pictures: HandPictures) -> App {
    app_with(RecorderPlugin {
        folder: place.demo(),
        channels: Channels {
            depth: true,
            ids: true,
        },
        hand_pictures,
        ..default()
    })
}

/// Records a script whose commands come after so many ticks, until the clock stands at 150.
fn record(hand_pictures: HandPictures, script: &[(u64, SimCommand)]) -> Place {
    let place = Place::new();
    let mut app = recorder(&place, hand_pictures);
    let start = SimCommand::Recording(RecordingCommand::Start);
    run(&mut app, &[(0, scene(&["a", "still"])), (3, start)]);
    run(&mut app, script);
    let now = app.world().resource::<SimTick>().0;
    let finish = SimCommand::Recording(RecordingCommand::Finish);
    run(&mut app, &[(150 - now, finish)]);
    place
}

#[test]
fn each_picture_of_the_head_camera_has_one_of_each_hand_camera_beside_it() {
    let place = record(HandPictures::OfAll, &[(20, grasp(Hand::Left, "a"))]);
    let recording = RecordingReader::open(place.demo()).unwrap();
    let cameras = &recording.header().hand_cameras;
    let names: Vec<_> = cameras.iter().map(|camera| &*camera.name).collect();
    assert_eq!(names, ["left_camera", "right_camera"]);
    let segments = recording.segments().unwrap();
    let frames: Vec<_> = segments.iter().flat_map(|it| &it.frames).collect();
    assert!(frames.len() > 5);
    for frame in frames {
        let pictures = frame.hand_pictures.iter();
        let pictures: Vec<_> = pictures.map(|(name, file)| (&**name, file)).collect();
        let [("left_camera", left), ("right_camera", right)] = pictures[..] else {
            panic!("{pictures:?}");
        };
        for picture in [left, right] {
            let path = picture.path();
            assert!(path.is_file() && path.parent() == frame.picture.path().parent());
            for channel in ["depth", "ids"] {
                assert!(path.with_extension(format!("{channel}.png")).is_file());
            }
        }
        let size = |picture: &InnerFile| {
            let file = std::io::BufReader::new(picture.open().unwrap());
            let reader = png::Decoder::new(file).read_info().unwrap();
            (reader.info().width, reader.info().height)
        };
        assert_eq!((size(&frame.picture), size(left)), ((4, 3), (5, 2)));
        assert_ne!(left.read(1 << 20).unwrap(), right.read(1 << 20).unwrap());
    }
}

#[test]
fn without_them_a_recording_is_as_it_was() {
    let script = [(20, grasp(Hand::Left, "a"))];
    let tree = record(HandPictures::None, &script).tree();
    assert!(tree.keys().all(|name| !name.contains("camera")));
    let header = tree["session.jsonl"].split(|byte| *byte == b'\n').next();
    let header = String::from_utf8_lossy(header.unwrap());
    assert!(!header.contains("hand_cameras"), "{header}");
    // And with them, everything else is the same.
    let with = record(HandPictures::OfAll, &script).tree();
    for (name, content) in tree.iter().filter(|(name, _)| *name != "session.jsonl") {
        assert!(with[name] == *content, "{name}");
    }
}

#[test]
fn undone_hand_pictures_were_never_taken_and_redone_ones_come_back() {
    let undo = || SimCommand::History(HistoryCommand::Undo);
    let redo = || SimCommand::History(HistoryCommand::Redo);
    let grasped = || (20, grasp(Hand::Left, "a"));
    for (done, undone) in [
        (vec![], vec![grasped(), (47, undo())]),
        (vec![grasped()], vec![grasped(), (63, undo()), (33, redo())]),
    ] {
        let [done, undone] =
            [done, undone].map(|script| record(HandPictures::OfAll, &script).tree());
        assert!(done == undone, "{:?} {:?}", done.keys(), undone.keys());
    }
}

#[test]
fn an_undone_segment_keeps_its_hand_pictures_until_it_cannot_be_redone() {
    let place = Place::new();
    let mut app = recorder(&place, HandPictures::OfAll);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (3, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(Hand::Left, "a")),
            (40, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
    let recording = RecordingReader::open(place.demo()).unwrap();
    let undone = recording.undone().unwrap();
    assert_eq!(undone[0].frames[0].hand_pictures.len(), 2);
    let held = files_in(&place.demo().join(".undone"));
    assert!(held.keys().any(|name| name.ends_with(".left_camera.png")));
    drop(app);
}

#[test]
fn hand_cameras_see_the_robot_move() {
    let frames = |hand_pictures| {
        let place = Place::new();
        let mut app = recorder(&place, hand_pictures);
        let start = SimCommand::Recording(RecordingCommand::Start);
        run(&mut app, &[(0, scene(&["still"])), (3, start)]);
        app.step(40);
        app.world_mut().resource_mut::<Robot>().joints[3].position += 0.1;
        app.step(40);
        app.world_mut().write_command(RecordingCommand::Finish);
        app.step(1);
        let recording = RecordingReader::open(place.demo()).unwrap();
        let segments = recording.segments().unwrap();
        segments[0]
            .frames
            .iter()
            .map(|it| it.number)
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(frames(HandPictures::None), [0].into());
    assert_eq!(frames(HandPictures::OfAll), [0, 3].into());
}

#[test]
fn a_header_with_cameras_that_cannot_be_is_refused() {
    let place = record(HandPictures::OfAll, &[]);
    let log = place.read("session.jsonl");
    for (from, to, problem) in [
        ("left_camera", "../left", "is no name of a camera"),
        (
            "left_camera",
            "right_camera",
            "there are two cameras right_camera",
        ),
        (
            "\"width\":5",
            "\"width\":50000",
            "50000x2 is no size of a picture",
        ),
        ("\"width\":5", "\"width\":-5", "invalid value"),
        (
            "\"vertical_fov\":1.0",
            "\"vertical_fov\":9.0",
            "an angle of view of 9 rad",
        ),
        ("\"link\":", "\"lnik\":", "unknown field"),
    ] {
        assert!(log.contains(from), "{from}");
        fs::write(
            place.demo().join("session.jsonl"),
            log.replacen(from, to, 1),
        )
        .unwrap();
        let error = RecordingReader::open(place.demo()).unwrap_err().to_string();
        assert!(error.contains("session.jsonl:1: "), "{error}");
        assert!(error.contains(problem), "{from}: {error}");
    }
}
