//! Recordings are read as they were made.

use std::fs;

use bevy::{math::Vec3, prelude::default};
use tabletop_core::{
    Hand, HandCommand, HistoryCommand, ObjectSpec, Part, Recording, RecordingCommand, SceneCommand,
    SceneItem, SceneSpec, Shape, SimCommand, SimTick, StepApp as _, Timeline, TimelinePicture,
    TimelineStage,
};
use tabletop_geometry::Pose;
use tabletop_recorder::{Occurrence, RecordingReader};

#[cfg(unix)]
use crate::stage::files_in;
use crate::stage::{Place, app, block, grasp, location, run, scene};

const LEFT: Hand = Hand::Left;
const RIGHT: Hand = Hand::Right;

/// A recording with everything that begins segments, and its timeline while it was made.
fn recorded(place: &Place, script: &[(u64, SimCommand)]) -> Timeline {
    let mut app = app(place);
    let begin = [
        (0, scene(&["a", "bb", "still"])),
        (3, SimCommand::Recording(RecordingCommand::Start)),
    ];
    run(&mut app, &begin);
    run(&mut app, script);
    app.world().resource::<Timeline>().clone()
}

fn demonstration() -> Vec<(u64, SimCommand)> {
    vec![
        (20, grasp(LEFT, "a")),
        (7, SimCommand::Hand(HandCommand::Release(LEFT))),
        (0, grasp(RIGHT, "a")),
        (30, grasp(LEFT, "a")),
        (9, SimCommand::Hand(HandCommand::Destroy(RIGHT))),
        (9, SimCommand::Hand(HandCommand::Destroy(LEFT))),
        (50, SimCommand::Recording(RecordingCommand::Finish)),
    ]
}

/// The common part of the timelines of a running recording and of one that is read.
fn comparable(timeline: &Timeline) -> Timeline {
    let pictures = timeline.pictures.iter();
    Timeline {
        stage: TimelineStage::Absent,
        pictures: pictures
            .map(|picture| TimelinePicture {
                serial: 0,
                ..picture.clone()
            })
            .collect(),
        ..timeline.clone()
    }
}

#[test]
fn the_timeline_of_a_recording_is_the_one_with_which_it_was_made() {
    let place = Place::new();
    let made = recorded(&place, &demonstration());
    assert_eq!(made.stage, TimelineStage::Finished);
    let read = RecordingReader::open(place.demo()).unwrap();
    let timeline = read.timeline().unwrap();
    assert_eq!(timeline.stage, TimelineStage::Open);
    assert_eq!(comparable(&timeline), comparable(&made));
    let acts = timeline.segments.iter().map(|segment| {
        let act = segment.act.as_ref();
        (segment.start.0, act.map(ToString::to_string))
    });
    let expected = [
        (3, None),
        (24, Some("LeftHand grasps a")),
        (31, Some("LeftHand releases a")),
        (31, Some("RightHand grasps a")),
        (61, Some("RightHand releases a")),
        (61, Some("LeftHand grasps a")),
        (79, Some("LeftHand destroys a")),
    ];
    let expected = expected.map(|(tick, act)| (tick, act.map(str::to_owned)));
    assert_eq!(acts.collect::<Vec<_>>(), expected);
}

#[test]
fn undo_takes_its_segments_off_the_timeline_and_redo_brings_them_back() {
    for turns in [
        vec![(3, SimCommand::History(HistoryCommand::Undo))],
        vec![
            (3, SimCommand::History(HistoryCommand::Undo)),
            (0, SimCommand::History(HistoryCommand::Undo)),
        ],
        vec![
            (3, SimCommand::History(HistoryCommand::Undo)),
            (5, SimCommand::History(HistoryCommand::Redo)),
        ],
        vec![
            (3, SimCommand::History(HistoryCommand::Undo)),
            (0, SimCommand::History(HistoryCommand::Undo)),
            (20, SimCommand::History(HistoryCommand::Redo)),
            (0, SimCommand::History(HistoryCommand::Redo)),
            (1, SimCommand::History(HistoryCommand::Undo)),
        ],
    ] {
        let place = Place::new();
        let mut script = demonstration();
        script.pop();
        script.extend(turns);
        script.push((40, SimCommand::Recording(RecordingCommand::Finish)));
        let made = recorded(&place, &script);
        let read = RecordingReader::open(place.demo()).unwrap();
        assert_eq!(comparable(&read.timeline().unwrap()), comparable(&made));
    }
}

#[test]
fn events_pictures_states_and_joints_are_read_with_their_ticks() {
    let place = Place::new();
    recorded(&place, &demonstration());
    let recording = RecordingReader::open(place.demo()).unwrap();
    assert_eq!(
        (recording.first_tick(), recording.cut_off_at()),
        (SimTick(3), None)
    );
    let last = recording.last_tick();
    let segments = recording.segments().unwrap();
    assert_eq!(segments.len(), 7);
    for segment in &segments {
        for frame in &segment.frames {
            assert_eq!(frame.tick.0, (3 + 15 * frame.number).min(last.0));
            assert!(frame.picture.open().is_ok());
        }
    }
    let moves = segments.iter().flat_map(|segment| &segment.events);
    for event in moves {
        if let Occurrence::Move {
            id,
            location: at,
            degrees,
        } = &event.what
        {
            let tick = (3 + 15 * event.frame).min(last.0);
            assert_eq!((*at, *degrees), (location(id, SimTick(tick)), Vec3::ZERO));
        }
    }
    for tick in [3, 10, 60, last.0] {
        let states = recording.states_at(SimTick(tick)).unwrap();
        assert_eq!(states.keys().collect::<Vec<_>>(), ["a", "bb", "still"]);
        let place = states["bb"].pose.location;
        assert_eq!(place, location("bb", SimTick(tick)));
    }
    assert_eq!(recording.states_at(SimTick(2)).unwrap().len(), 0);
    assert_eq!(recording.joints().unwrap().len(), 17);
    assert!(recording.joints_at(last).is_ok());
}

#[test]
fn truncated_files_are_read_as_far_as_they_go() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (0, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(LEFT, "a")),
        ],
    );
    app.step(20);
    let half = |file: &str| {
        let path = place.demo().join(file);
        let mut bytes = fs::read(&path).unwrap();
        bytes.extend(b"40,half a li");
        fs::write(path, bytes).unwrap();
    };
    for file in ["1.txt", "states.csv", "joints.csv"] {
        half(file);
    }
    let recording = RecordingReader::open(place.demo()).unwrap();
    assert_eq!(recording.cut_off_at(), Some(recording.last_tick()));
    let timeline = recording.timeline().unwrap();
    let running = app.world().resource::<Timeline>();
    assert_eq!(timeline.segments, running.segments);
    assert_eq!(timeline.end, running.end);
    assert!(recording.states().is_ok() && recording.joints().is_ok());
}

#[test]
fn missing_and_damaged_files_are_errors_with_their_place() {
    let place = Place::new();
    let error = RecordingReader::open(place.path()).unwrap_err().to_string();
    assert!(error.contains("session.jsonl"), "{error}");
    recorded(&place, &demonstration());
    let recording = RecordingReader::open(place.demo()).unwrap();
    for file in ["1.txt", "states.csv", "joints.csv"] {
        let path = place.demo().join(file);
        fs::write(&path, "tick,what\n1,nonsense\n").unwrap();
        let error = match file {
            "1.txt" => recording.segments().unwrap_err(),
            "states.csv" => recording.states().unwrap_err(),
            _ => recording.joints().unwrap_err(),
        };
        let error = error.to_string();
        assert!(
            error.starts_with(&format!("{}:", path.display())),
            "{error}"
        );
        assert!(
            error.ends_with("the file was changed, or is damaged"),
            "{error}"
        );
        fs::write(&path, "").unwrap();
    }
}

#[test]
fn composites_in_composites_are_recorded_and_read() {
    let place = Place::new();
    let mut app = app(&place);
    let nested = (0..99).fold(block("it").shape, |shape, _| Shape::Composite {
        parts: vec![Part {
            pointable: false,
            id: String::new(),
            pose: Pose::IDENTITY,
            shape,
        }],
    });
    let object = ObjectSpec {
        shape: nested,
        ..block("it")
    };
    let scene = SceneSpec {
        items: vec![SceneItem::Object(object.clone())],
        ..default()
    };
    let set: SimCommand = SceneCommand::Set(Box::new(scene)).into();
    run(
        &mut app,
        &[
            (0, set.clone()),
            (1, RecordingCommand::Start.into()),
            (1, set.clone()),
            (1, RecordingCommand::Finish.into()),
        ],
    );
    let recording = RecordingReader::open(place.demo()).unwrap();
    let session = recording.session();
    assert_eq!(session.scene.objects[0].spec, object);
    assert_eq!(session.earlier[0].command, set);
    assert_eq!(session.commands[0].command, set);
}

#[test]
fn a_command_that_cannot_be_written_ends_the_recording() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (0, RecordingCommand::Start.into()),
            (
                5,
                HandCommand::MoveTo {
                    hand: LEFT,
                    location: Vec3::NAN,
                }
                .into(),
            ),
            (5, HandCommand::Select(LEFT).into()),
        ],
    );
    let recording = RecordingReader::open(place.demo()).unwrap();
    assert_eq!(recording.cut_off_at(), Some(SimTick(4)));
    assert!(!app.world().resource::<Recording>().0);
}

#[cfg(unix)]
#[test]
fn links_and_devices_are_not_read() {
    let place = Place::new();
    recorded(&place, &demonstration());
    let elsewhere = place.path().join("elsewhere");
    fs::write(&elsewhere, "0,create,a\n").unwrap();
    for target in ["/dev/zero".as_ref(), &*elsewhere] {
        for file in ["1.txt", "states.csv", "joints.csv", "session.jsonl"] {
            let path = place.demo().join(file);
            let content = fs::read(&path).unwrap();
            fs::remove_file(&path).unwrap();
            std::os::unix::fs::symlink(target, &path).unwrap();
            let read = RecordingReader::open(place.demo()).and_then(|recording| {
                recording.segments()?;
                recording.states()?;
                recording.joints()
            });
            let error = read.unwrap_err().to_string();
            assert!(error.contains("it is no file but a link"), "{error}");
            assert!(error.contains(file), "{error}");
            fs::remove_file(&path).unwrap();
            fs::write(&path, content).unwrap();
        }
    }
}

/// Else the recovery of an interrupted undo would move files from or to any folder.
#[cfg(unix)]
#[test]
fn undone_segments_are_not_looked_for_in_other_folders() {
    let put_away = r#"{"PutAway":{"segment":1,"before":BEFORE,"then":""}}"#;
    let bring_back = r#"{"BringBack":{"segment":1,"before":BEFORE,"first_frame":0}}"#;
    let before = r#"{"segment":0,"text":0,"session":0,"states":0,"joints":0}"#;
    for linked in [".undone", ".undone/1"] {
        for intent in [None, Some(put_away), Some(bring_back)] {
            let place = Place::new();
            let script = [
                (20, grasp(LEFT, "a")),
                (40, SimCommand::History(HistoryCommand::Undo)),
            ];
            recorded(&place, &script);
            let [linked, elsewhere] = [place.demo().join(linked), place.path().join("elsewhere")];
            fs::rename(&linked, &elsewhere).unwrap();
            std::os::unix::fs::symlink(&elsewhere, &linked).unwrap();
            if let Some(intent) = intent {
                let intent = intent.replace("BEFORE", before);
                fs::write(place.demo().join(".intent.json"), intent).unwrap();
            }
            let there = [files_in(&elsewhere), place.tree()];
            let read = RecordingReader::open(place.demo()).and_then(|read| read.undone());
            let error = read.unwrap_err().to_string();
            assert!(
                error.contains(".undone") && error.contains("no folder"),
                "{error}"
            );
            assert_eq!([files_in(&elsewhere), place.tree()], there);
        }
    }
}
