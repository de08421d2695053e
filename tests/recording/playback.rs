//! Recordings that are opened while the simulator runs.

use std::{fs, path::Path};

use bevy::prelude::*;
use tabletop::{
    core::{OpenRecording, Playback, PlaybackOrder, Timeline, TimelineStage},
    dataset::import_recording,
    prelude::*,
    recorder::RecordingReader,
    replay::PlaybackPlugin,
    user::{PacePlugin, SingleStep},
};

use crate::{
    demonstration::{Demonstration, assert_replays, bits},
    window::Window,
};

const HAND: Hand = Hand::Right;

/// A recording of two blocks, one of which is put onto the other.
fn recording(name: &str) -> Demonstration {
    let mut demonstration = Demonstration::new(name);
    let object = "RedBlock".to_owned();
    // It pushes the other block off the table, which falls out of the world.
    let location = Vec3::new(-1.8, 0.1, 3.4);
    demonstration.act(&[
        (vec![task()], 30),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 20),
        (
            vec![SimCommand::Hand(HandCommand::Grasp { hand: HAND, object })],
            5,
        ),
        (
            vec![SimCommand::Hand(HandCommand::MoveTo {
                hand: HAND,
                location,
            })],
            60,
        ),
        (vec![SimCommand::Hand(HandCommand::Release(HAND))], 400),
        (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
    ]);
    demonstration
}

fn task() -> SimCommand {
    SimCommand::Scene(SceneCommand::Load("tablesetup/default.xml".into()))
}

/// A window that opens recordings, in which something was done already.
fn used_window(name: &str) -> Window {
    let playback = PlaybackPlugin {
        task: "tablesetup/tower.xml".into(),
    };
    let mut window = Window::open(name, |plugins| plugins.add(PacePlugin).add(playback));
    window.give(SceneCommand::Load("tablesetup/lidbox.xml".into()));
    window.frames(20);
    window.give(RobotCommand::Show(true));
    window.give(HandCommand::Grasp {
        hand: Hand::Left,
        object: "obj-lid".into(),
    });
    window.frames(20);
    window
}

impl Window {
    fn open_recording(&mut self, folder: &Path) {
        self.write(OpenRecording(folder.to_owned()));
        self.frames(1);
        self.arrive();
    }

    /// Waits until the world is where it was to go.
    fn arrive(&mut self) {
        self.frames_until(|world| world.resource::<Playback>().goal.is_none());
    }

    fn look_at(&mut self, tick: u64) {
        self.write(PlaybackOrder::StopAt(SimTick(tick)));
        self.frames(1);
        self.arrive();
        self.frames(3);
    }

    /// Pose of every object, as the recording has it.
    fn poses(&self) -> Vec<(String, Pose)> {
        let world = self.app.world();
        let index = world.resource::<ObjectIndex>();
        let mut poses: Vec<_> = index
            .ids()
            .map(|id| {
                let object = index.get(id).unwrap();
                (
                    id.to_owned(),
                    world.get::<Transform>(object).unwrap().into(),
                )
            })
            .collect();
        poses.sort_by(|a: &(String, Pose), b| a.0.cmp(&b.0));
        poses
    }
}

/// Poses of the objects that had not yet fallen off the world.
fn recorded_poses(recording: &RecordingReader, tick: u64) -> Vec<(String, Pose)> {
    let states = recording.states_at(SimTick(tick)).unwrap();
    let poses = states.into_iter().map(|(id, row)| (id, row.pose));
    poses.filter(|(_, pose)| pose.location.z > -990.0).collect()
}

#[test]
fn an_imported_recording_is_shown_at_any_moment() {
    let demonstration = recording("imported");
    let source = demonstration.folder.with_extension("source");
    let out = demonstration.folder.with_extension("imported");
    let _not_there = fs::remove_dir_all(&source);
    fs::create_dir_all(&source).unwrap();
    for segment in ["0.txt", "1.txt", "2.txt"] {
        fs::copy(demonstration.folder.join(segment), source.join(segment)).unwrap();
    }
    import_recording(&source, &out, None).unwrap();
    let reader = RecordingReader::open(&out).unwrap();
    let mut window = used_window("imported_window");
    window.open_recording(&out);
    assert_eq!(window.app.world().resource::<Timeline>().segments.len(), 3);
    for tick in [90, 0, 33, 34, 20, 60] {
        window.look_at(tick);
        let found = window.poses();
        let expected = recorded_poses(&reader, tick);
        assert_eq!(found.len(), expected.len());
        for ((id, pose), (other, expected)) in found.iter().zip(&expected) {
            let way = pose.location.distance(expected.location);
            assert!(
                id == other && way < 1e-3,
                "tick {tick}: {id} {pose:?}, {expected:?}"
            );
        }
    }
}

#[test]
fn the_world_goes_to_any_moment_and_is_as_it_was() {
    let demonstration = recording("moments");
    let reader = RecordingReader::open(&demonstration.folder).unwrap();
    let (start, end) = (reader.first_tick().0, reader.last_tick().0);
    let mut window = used_window("moments_window");
    window.open_recording(&demonstration.folder);
    for tick in [
        end,
        start,
        start + 60,
        start + 300,
        start + 301,
        start + 20,
        end - 1,
        end,
    ] {
        window.look_at(tick);
        assert_eq!(window.next_tick(), tick + 1);
        assert!(window.app.world().resource::<Paused>().0);
        assert_eq!(window.poses(), recorded_poses(&reader, tick), "tick {tick}");
    }
    assert!(window.app.world().resource::<Playback>().is_over);
    assert_eq!(bits(&window.app), demonstration.bits());
}

#[test]
fn a_recording_that_is_opened_plays_to_its_end_and_the_user_goes_on_and_records() {
    let demonstration = recording("played");
    let mut window = used_window("played_window");
    window.open_recording(&demonstration.folder);
    window.look_at(300);
    window.look_at(100);
    window.give(ClockCommand::SetPaused(false));
    window.give(HandCommand::Release(HAND));
    window.frames(450);
    assert!(window.app.world().resource::<Playback>().is_over);
    window.give(RecordingCommand::Start);
    window.frames(5);
    let timeline = window.app.world().resource::<Timeline>();
    assert_eq!(timeline.stage, TimelineStage::Running);
    assert_eq!(timeline.folder, window.folder);
    let object = "GreenBlock".to_owned();
    window.give(HandCommand::Grasp { hand: HAND, object });
    window.frames(30);
    window.give(RecordingCommand::Finish);
    window.frames(5);

    assert_replays(&window.folder);
}

#[test]
fn a_closed_recording_leaves_a_fresh_task() {
    let demonstration = recording("put_away");
    let mut window = used_window("put_away_window");
    window.open_recording(&demonstration.folder);
    window.look_at(200);
    window.write(PlaybackOrder::Close);
    window.frames(30);
    let world = window.app.world();
    assert_eq!(world.resource::<Timeline>().stage, TimelineStage::Absent);
    assert_eq!(*world.resource::<Playback>(), Playback::default());
    assert!(!world.resource::<Paused>().0);
    assert!(!world.resource::<Robot>().is_shown);
    let index = world.resource::<ObjectIndex>();
    assert!(
        index.get("obj-lid").is_some(),
        "the task that was loaded last"
    );
    let next = window.next_tick();
    assert!((20..40).contains(&next), "{next}");
}

#[test]
fn a_recording_that_ends_in_a_pause_is_gone_through() {
    let mut demonstration = Demonstration::new("ends_in_a_pause");
    demonstration.act(&[
        (vec![task()], 30),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 20),
        (vec![SimCommand::Clock(ClockCommand::SetPaused(true))], 3),
        (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
    ]);
    let mut window = used_window("ends_in_a_pause_window");
    window.open_recording(&demonstration.folder);
    for _ in 0..2 {
        window.look_at(1000);
        assert!(window.app.world().resource::<Playback>().is_over);
        assert_eq!(window.next_tick(), 50);
        window.look_at(40);
        assert_eq!(window.next_tick(), 41);
    }
}

#[test]
fn a_recording_that_loops_begins_again() {
    let demonstration = recording("looping");
    let mut window = used_window("looping_window");
    window.open_recording(&demonstration.folder);
    let (start, end) = {
        let timeline = window.app.world().resource::<Timeline>();
        (timeline.start.0, timeline.end.0)
    };
    window.write(PlaybackOrder::Loop(true));
    window.write(PlaybackOrder::GoTo(SimTick(end - 3)));
    window.frames(1);
    window.arrive();
    window.frames(20);
    let next = window.next_tick();
    assert!((start..start + 20).contains(&next), "{next}");
    assert!(!window.app.world().resource::<Paused>().0);
}

#[test]
fn an_unreadable_recording_is_reported_in_one_line() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_recording");
    let _there_already = fs::create_dir_all(&folder);
    let moon = recording("moon_recording");
    let session = moon.folder.join("session.jsonl");
    let text = fs::read_to_string(&session).unwrap();
    fs::write(&session, text.replacen("98.1", "16.2", 1)).unwrap();
    let damaged = recording("damaged_recording");
    fs::write(damaged.folder.join("1.txt"), "2,grasp,Foot,RedBlock\n").unwrap();
    for (folder, words) in [
        (&folder, "there is no session.jsonl in it"),
        (
            &moon.folder,
            "settings.physics.gravity was 16.2, and is 98.1 here; `tabletop replay ",
        ),
        (&damaged.folder, "1.txt:1: expected a hand"),
    ] {
        let mut window = used_window("unopened_window");
        let before = window.poses();
        window.write(OpenRecording(folder.clone()));
        window.frames(1);
        let facts = window.app.world().resource::<Messages<SimFact>>();
        let mut refusals = facts.iter_current_update_messages().filter_map(|fact| {
            let SimFact::Refused { reason, .. } = fact else {
                return None;
            };
            Some(reason)
        });
        let reason = refusals.next().unwrap();
        assert!(reason.contains(words), "{reason}");
        assert!(reason.contains(folder.to_str().unwrap()), "{reason}");
        assert_eq!(reason.lines().count(), 1, "{reason}");
        assert_eq!(refusals.next(), None);
        assert_eq!(window.poses().len(), before.len());
    }
}

#[test]
fn while_a_recording_is_made_none_is_opened() {
    let demonstration = recording("closed");
    let mut window = used_window("recording_window");
    window.give(RecordingCommand::Start);
    window.frames(5);
    window.write(OpenRecording(demonstration.folder.clone()));
    window.frames(1);
    let timeline = window.app.world().resource::<Timeline>();
    assert_eq!(timeline.stage, TimelineStage::Running);
    assert_eq!(timeline.folder, window.folder);
}

#[test]
fn a_recording_made_in_single_steps_replays_to_the_same_bytes() {
    let mut window = used_window("steps");
    window.give(RecordingCommand::Start);
    window.frames(10);
    window.give(ClockCommand::SetPaused(true));
    window.frames(3);
    for steps in 1..20 {
        let before = window.next_tick();
        window
            .app
            .world_mut()
            .write_message_batch(vec![SingleStep; steps % 4]);
        window.frames(6);
        assert_eq!(window.next_tick(), before + (steps % 4) as u64);
        if steps == 9 {
            window.give(SceneCommand::Load("tablesetup/default.xml".into()));
            window.frames(2);
        }
    }
    window.give(ClockCommand::SetPaused(false));
    window.frames(20);
    window.give(RecordingCommand::Finish);
    window.frames(2);
    assert_replays(&window.folder);
}
