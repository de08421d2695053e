//! Contents of a recording's files.

use std::{collections::BTreeMap, fs};

use bevy::prelude::App;
use tabletop_core::{
    ClockCommand, Hand, HandCommand, HistoryCommand, ObjectIndex, ObjectSpec, Recording,
    RecordingCommand, Robot, SceneCommand, Shape, SimCommand, SimTick, StepApp as _,
    WriteCommand as _,
};
use tabletop_geometry::Rgb;
use tabletop_recorder::{Session, SessionCommand};

use crate::stage::{Place, app, block, grasp, location, run, scene};

const CREATED: &str = "shape,block,xspan,1.0,zspan,1.0,yspan,1.0,color,#ff0000,mass,1.0";

#[test]
fn a_demonstration_is_written_as_the_original_program_does() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["zz", "a", "still"])),
            (100, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(Hand::Left, "a")),
            (20, SimCommand::Hand(HandCommand::Release(Hand::Left))),
            (20, grasp(Hand::Right, "zz")),
            (5, SimCommand::Hand(HandCommand::Destroy(Hand::Right))),
            (20, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    assert_eq!(
        place.read("0.txt"),
        format!(
            "0,create,zz,{CREATED}\n\
             0,create,a,{CREATED}\n\
             0,create,still,{CREATED}\n\
             0,move,zz,1.0,2.0,0.5,0.0,0.0,0.0\n\
             0,move,a,1.0,1.0,0.5,0.0,0.0,0.0\n\
             0,move,still,0.0,5.0,0.5,0.0,0.0,0.0\n\
             1,move,zz,1.15,2.0,0.5,0.0,0.0,0.0\n\
             1,move,a,1.15,1.0,0.5,0.0,0.0,0.0\n"
        )
    );
    assert_eq!(
        place.read("1.txt"),
        "2,grasp,LeftHand,a\n\
         2,move,zz,1.3,2.0,0.5,0.0,0.0,0.0\n\
         2,move,a,1.3,1.0,0.5,0.0,0.0,0.0\n"
    );
    assert_eq!(
        place.read("2.txt"),
        "3,release,LeftHand\n\
         3,move,zz,1.4499999,2.0,0.5,0.0,0.0,0.0\n\
         3,move,a,1.4499999,1.0,0.5,0.0,0.0,0.0\n"
    );
    assert_eq!(
        place.read("3.txt"),
        "4,grasp,RightHand,zz\n\
         4,move,zz,1.5999999,2.0,0.5,0.0,0.0,0.0\n\
         4,move,a,1.5999999,1.0,0.5,0.0,0.0,0.0\n"
    );
    assert_eq!(
        place.read("4.txt"),
        "5,delete,zz\n5,destroy,RightHand\n5,move,a,1.75,1.0,0.5,0.0,0.0,0.0\n\
         6,move,a,1.8499999,1.0,0.5,0.0,0.0,0.0\n"
    );
    let frames: Vec<_> = (0..5).map(|segment| place.frames(segment)).collect();
    assert_eq!(frames, [vec![0, 1], vec![2], vec![3], vec![4], vec![5, 6]]);
    assert!(!place.demo().join("5.txt").exists());
}

#[test]
fn a_picture_shows_its_frame() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (7, SimCommand::Recording(RecordingCommand::Start)),
            (40, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    assert_eq!(place.frames(0), [0, 1, 2, 3]);
    let end = 7 + 40;
    for frame in 0..4_u8 {
        let file = fs::File::open(place.demo().join(format!("0/{frame}.png"))).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (4, 3));
        let grey = end.min(7 + 15 * frame);
        assert_eq!(pixels[..4], [grey, grey, grey, 255]);
    }
}

#[test]
fn frames_are_counted_without_drift_for_ten_minutes() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (11, SimCommand::Recording(RecordingCommand::Start)),
            (
                10 * 60 * 60,
                SimCommand::Recording(RecordingCommand::Finish),
            ),
        ],
    );
    let expected: Vec<u64> = (0..=10 * 60 * 4).collect();
    assert_eq!(place.frames(0), expected);
    let text = place.read("0.txt");
    let moves: Vec<(u64, f32)> = text
        .lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<_> = line.split(',').collect();
            (fields[0].parse().unwrap(), fields[3].parse().unwrap())
        })
        .collect();
    let expected: Vec<_> = expected
        .into_iter()
        .map(|frame| (frame, location("a", SimTick(11 + 15 * frame)).x))
        .collect();
    assert_eq!(moves, expected);
}

#[test]
fn while_nothing_changes_frames_are_counted_and_nothing_is_written() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["still"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (100, scene(&["still", "still more"])),
            (30, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    assert_eq!(place.frames(0), [0, 7]);
    let text = place.read("0.txt");
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(
        lines,
        [
            &format!("0,create,still,{CREATED}"),
            "0,move,still,0.0,5.0,0.5,0.0,0.0,0.0",
            "7,delete,still",
            &format!("7,create,still,{CREATED}"),
            &format!("7,create,still more,{CREATED}"),
            "7,move,still,0.0,5.0,0.5,0.0,0.0,0.0",
            "7,move,still more,0.0,10.0,0.5,0.0,0.0,0.0",
        ]
    );
}

/// Reads a recording as scripts for the original program do: every line split at its commas.
fn read_as_the_original(text: &str) -> BTreeMap<String, Vec<f32>> {
    let mut poses = BTreeMap::new();
    let mut previous = 0;
    for line in text.lines() {
        let fields: Vec<_> = line.split(',').collect();
        let frame: u64 = fields[0].parse().unwrap();
        assert!(frame >= previous, "{line} comes late");
        previous = frame;
        match fields[1..] {
            ["create", id, "shape", _, ref pairs @ ..] => {
                assert!(pairs.len().is_multiple_of(2), "{line}");
                poses.insert(id.to_owned(), Vec::new());
            }
            ["delete", id] => assert!(poses.remove(id).is_some(), "{line}"),
            ["move", id, ref numbers @ ..] => {
                assert_eq!(numbers.len(), 6, "{line}");
                let numbers = numbers.iter().map(|number| number.parse().unwrap());
                *poses.get_mut(id).unwrap() = numbers.collect();
            }
            [
                "grasp",
                "LeftHand" | "RightHand" | "BothHands" | "AnyHand",
                id,
            ] => {
                assert!(poses.contains_key(id), "{line}");
            }
            [
                "release" | "destroy",
                "LeftHand" | "RightHand" | "BothHands" | "AnyHand",
            ] => {}
            _ => panic!("{line}"),
        }
    }
    poses
}

#[test]
fn a_reader_for_the_original_program_reads_a_recording() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a", "bb", "still"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(Hand::Any, "a")),
            (40, SimCommand::Hand(HandCommand::Destroy(Hand::Any))),
            (30, grasp(Hand::Both, "bb")),
            (15, SimCommand::Hand(HandCommand::Release(Hand::Both))),
            (14, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    let text: String = (0..=4).map(|n| place.read(&format!("{n}.txt"))).collect();
    let poses = read_as_the_original(&text);
    assert_eq!(poses.keys().collect::<Vec<_>>(), ["bb", "still"]);
    let end = location("bb", SimTick(1 + 20 + 40 + 30 + 15 + 14));
    assert_eq!(poses["bb"], [end.x, 2.0, 0.5, 0.0, 0.0, 0.0]);
    assert_eq!(poses["still"], [0.0, 5.0, 0.5, 0.0, 0.0, 0.0]);
}

#[test]
fn states_hold_every_tick_of_moving_objects() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a,b", "still"])),
            (5, SimCommand::Recording(RecordingCommand::Start)),
            (50, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    let states = place.read("states.csv");
    let mut reader = csv::Reader::from_reader(states.as_bytes());
    assert_eq!(
        reader.headers().unwrap(),
        vec![
            "tick", "id", "x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz"
        ]
    );
    let rows: Vec<_> = reader.records().map(|row| row.unwrap()).collect();
    let of = |id: &str| -> Vec<(u64, f32)> {
        rows.iter()
            .filter(|row| &row[1] == id)
            .map(|row| (row[0].parse().unwrap(), row[2].parse().unwrap()))
            .collect()
    };
    let expected: Vec<_> = (5..=55)
        .map(|tick| (tick, location("a,b", SimTick(tick)).x))
        .collect();
    assert_eq!(of("a,b"), expected);
    assert_eq!(of("still"), [(5, 0.0)]);
}

#[test]
fn the_session_log_holds_the_scene_and_every_command() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (3, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (2, SimCommand::Recording(RecordingCommand::Start)),
            (0, grasp(Hand::Left, "a")),
            (4, SimCommand::Clock(ClockCommand::SetPaused(false))),
            (10, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    let session = Session::read(place.demo().join("session.jsonl")).unwrap();
    assert_eq!(session.header.start_tick, 3);
    assert_eq!(session.header.ticks_per_second, 60);
    let [object] = &session.scene.objects[..] else {
        panic!("{:?}", session.scene.objects);
    };
    assert_eq!(object.spec, block("a"));
    assert_eq!(object.pose.location, location("a", SimTick(2)));
    let reported = |commands: Vec<SessionCommand>| -> Vec<_> {
        let reported = commands.into_iter();
        reported
            .map(|reported| (reported.tick, reported.command))
            .collect()
    };
    assert_eq!(session.header.begin_tick, Some(0));
    assert_eq!(
        reported(session.earlier),
        [
            (0, scene(&["a"])),
            (3, SimCommand::Clock(ClockCommand::SetPaused(true)))
        ]
    );
    assert_eq!(
        reported(session.commands),
        [
            (3, grasp(Hand::Left, "a")),
            (3, SimCommand::Clock(ClockCommand::SetPaused(false))),
            (13, SimCommand::Recording(RecordingCommand::Finish)),
        ]
    );
    assert_eq!(
        place.read("1.txt").lines().next(),
        Some("0,grasp,LeftHand,a")
    );
}

#[test]
fn earlier_commands_include_an_earlier_recording_without_undone_ones() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (2, scene(&["a", "bb"])),
            (1, grasp(Hand::Left, "a")),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (9, grasp(Hand::Right, "bb")),
            (5, SimCommand::History(HistoryCommand::Undo)),
            (0, SimCommand::Hand(HandCommand::Release(Hand::Left))),
            (2, SimCommand::Recording(RecordingCommand::Finish)),
            (3, SimCommand::Scene(SceneCommand::Clear)),
            (2, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    let session = Session::read(place.demo().join("session.jsonl")).unwrap();
    assert_eq!(session.header.begin_tick, Some(2));
    let earlier: Vec<_> = session
        .earlier
        .into_iter()
        .map(|reported| reported.command)
        .collect();
    assert_eq!(
        earlier,
        [
            scene(&["a", "bb"]),
            grasp(Hand::Left, "a"),
            SimCommand::Hand(HandCommand::Release(Hand::Left)),
            SimCommand::Scene(SceneCommand::Clear),
        ]
    );
    assert_eq!(session.commands, []);
}

#[test]
fn a_scene_that_is_set_in_the_first_tick_is_the_one_recorded() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["old"])),
            (3, scene(&["new"])),
            (0, SimCommand::Recording(RecordingCommand::Start)),
            (0, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    assert_eq!(
        place.read("0.txt"),
        format!("0,create,new,{CREATED}\n0,move,new,0.03,3.0,0.5,0.0,0.0,0.0\n")
    );
    let session = Session::read(place.demo().join("session.jsonl")).unwrap();
    assert_eq!(session.scene.objects[0].spec.id, "old");
    assert_eq!(session.commands[0].command, scene(&["new"]));
}

#[test]
fn commands_in_a_pause_are_recorded() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, SimCommand::Recording(RecordingCommand::Start)),
            (1, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (5, scene(&["a"])),
            (5, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    assert_eq!(
        place.read("0.txt"),
        format!("1,create,a,{CREATED}\n1,move,a,0.0,0.0,0.0,0.0,0.0,0.0\n")
    );
    assert_eq!(place.frames(0), [1]);
    assert!(!app.world().resource::<Recording>().0);
}

#[test]
fn the_last_frame_tells_where_everything_is_that_is_not_where_its_last_line_says() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a", "still"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            // Two hundredths of a unit farther than at frame 2.
            (32, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    let text = place.read("0.txt");
    let last: Vec<_> = text.lines().filter(|line| line.starts_with("3,")).collect();
    assert_eq!(last, ["3,move,a,0.32999998,1.0,0.5,0.0,0.0,0.0"]);
    assert_eq!(place.frames(0), [0, 1, 2, 3]);
}

/// The frames of segment 0 if nothing moves, and this is done after 20 ticks.
fn frames_of_a_still_scene(act: impl FnOnce(&mut App)) -> Vec<u64> {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["still", "still more"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    app.step(20);
    act(&mut app);
    run(
        &mut app,
        &[(100, SimCommand::Recording(RecordingCommand::Finish))],
    );
    place.frames(0)
}

#[test]
fn appearing_vanishing_and_recoloured_objects_are_pictured_though_nothing_moves() {
    assert_eq!(frames_of_a_still_scene(|_| {}), [0]);
    assert_eq!(
        frames_of_a_still_scene(|app| {
            app.world_mut().write_command(SceneCommand::Clear);
        }),
        [0, 2]
    );
    assert_eq!(
        frames_of_a_still_scene(|app| {
            let still = app.world().resource::<ObjectIndex>().get("still").unwrap();
            let blue = ObjectSpec {
                shape: Shape::Sphere {
                    radius: 1.0,
                    color: Rgb::new(0.0, 0.0, 1.0),
                },
                ..block("still")
            };
            app.world_mut().entity_mut(still).insert(blue);
        }),
        [0, 2]
    );
    assert_eq!(
        frames_of_a_still_scene(|app| {
            app.world_mut().resource_mut::<Robot>().is_shown = true;
        }),
        [0, 2]
    );
}

#[test]
fn a_destroyed_object_is_gone_from_the_video() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["still", "still more"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(Hand::Left, "still")),
            (20, SimCommand::Hand(HandCommand::Destroy(Hand::Left))),
            (40, SimCommand::Recording(RecordingCommand::Finish)),
        ],
    );
    let frames: Vec<_> = (0..3).map(|segment| place.frames(segment)).collect();
    assert_eq!(frames, [vec![0], vec![], vec![3]]);
    assert_eq!(place.read("2.txt"), "3,delete,still\n3,destroy,LeftHand\n");
}
