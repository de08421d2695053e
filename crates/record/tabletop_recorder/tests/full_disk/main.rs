//! A full disk ends a recording, and costs none of the earlier lines.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../recorder/stage.rs"]
#[expect(dead_code, reason = "a full disk needs a part of it")]
mod stage;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use bevy::prelude::App;
use tabletop_core::{
    ClockCommand, Hand, HandCommand, Recording, RecordingCommand, RecordingFact, SimCommand,
    SimFact, StepApp as _,
};
use tabletop_harness::test_with;
use tabletop_recorder::Session;

use crate::stage::{Place, app_into, grasp, heard, run, scene};

fn main() -> ExitCode {
    tabletop_harness::run()
}

/// A disk of 256 KiB in memory.
struct SmallDisk(PathBuf);

impl SmallDisk {
    fn mount(path: PathBuf) -> Self {
        fs::create_dir(&path).unwrap();
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", "size=256k", "tmpfs"]);
        assert!(mount.arg(&path).status().unwrap().success());
        Self(path)
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _still_mounted = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

fn fill(disk: &Path, bytes: usize) {
    let _full = fs::write(disk.join("filler"), vec![0; bytes]);
}

/// The report of the one recording that failed.
fn failure(app: &mut App) -> (PathBuf, String) {
    let mut facts = heard(app);
    let place = |fact: &SimFact| matches!(fact, SimFact::Recording(RecordingFact::Failed { .. }));
    let failure = facts.iter().position(place).map(|at| facts.remove(at));
    let ends = |fact: &SimFact| {
        place(fact) || matches!(fact, SimFact::Recording(RecordingFact::Finished { .. }))
    };
    assert!(!facts.iter().any(ends), "{facts:?}");
    match failure {
        Some(SimFact::Recording(RecordingFact::Failed { folder, reason, .. })) => (folder, reason),
        _ => panic!("{facts:?}"),
    }
}

const IDS: [&str; 6] = ["a", "bb", "ccc", "dddd", "eeeee", "ffffff"];

#[test_with(Mounting)]
fn a_recording_is_complete_up_to_a_full_disk() {
    let place = Place::new();
    for round in 0..12 {
        let path = place.path().join(round.to_string());
        let disk = SmallDisk::mount(path);
        fill(&disk.0, round * 7_000);
        let demo = disk.0.join("demo");
        let mut app = app_into(demo.clone());
        run(
            &mut app,
            &[
                (0, scene(&IDS)),
                (0, SimCommand::Recording(RecordingCommand::Start)),
            ],
        );
        let mut ticks = 1;
        while app.world().resource::<Recording>().0 {
            let command = match ticks % 40 {
                0 => grasp(Hand::Left, "a"),
                20 => SimCommand::Hand(HandCommand::Release(Hand::Left)),
                _ => SimCommand::Hand(HandCommand::Select(Hand::Left)),
            };
            run(&mut app, &[(0, command)]);
            ticks += 1;
            assert!(ticks < 10_000, "the disk does not get full");
        }
        app.step(20);

        let (folder, reason) = failure(&mut app);
        assert_eq!(folder, demo);
        assert!(reason.contains("No space left"), "{reason}");
        assert!(reason.contains("free some space"), "{reason}");
        check_recording(&demo, ticks - 1);
    }
}

/// The last tick may be there or not, all before it must be.
fn check_recording(demo: &Path, ticks: u64) {
    let states = fs::read_to_string(demo.join("states.csv")).unwrap();
    assert!(states.ends_with('\n'));
    let mut seen: BTreeMap<u64, Vec<String>> = BTreeMap::new();
    for row in csv::Reader::from_reader(states.as_bytes()).records() {
        let row = row.unwrap();
        assert_eq!(row.len(), 15);
        let tick = row[0].parse().unwrap();
        seen.entry(tick).or_default().push(row[1].to_owned());
    }
    assert!(seen.len() as u64 >= ticks - 1, "{} of {ticks}", seen.len());
    for (expected, (tick, ids)) in seen.into_iter().enumerate() {
        assert_eq!(tick, expected as u64);
        assert_eq!(ids, IDS);
    }

    let session = Session::read(demo.join("session.jsonl")).unwrap();
    assert!(session.commands.len() as u64 >= ticks - 1);

    for segment in 0.. {
        let Ok(text) = fs::read_to_string(demo.join(format!("{segment}.txt"))) else {
            assert!(segment > 2, "only {segment} segments");
            break;
        };
        assert!(text.is_empty() || text.ends_with('\n'));
        for line in text.lines().filter(|line| line.contains(",move,")) {
            let (frame, _) = line.split_once(',').unwrap();
            let picture = demo.join(format!("{segment}/{frame}.png"));
            let file = std::io::BufReader::new(fs::File::open(picture).unwrap());
            let mut reader = png::Decoder::new(file).read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
        }
        for entry in fs::read_dir(demo.join(segment.to_string())).unwrap() {
            let name = entry.unwrap().file_name();
            assert!(name.to_string_lossy().ends_with(".png"), "{name:?}");
        }
    }
}

#[test_with(Mounting)]
fn a_last_frame_that_does_not_fit_is_not_there_at_all() {
    let place = Place::new();
    let disk = SmallDisk::mount(place.path().join("end"));
    let demo = disk.0.join("demo");
    let mut app = app_into(demo.clone());
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (0, SimCommand::Recording(RecordingCommand::Start)),
            (20, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (1, scene(&["bb"])),
        ],
    );
    let before = fs::read(demo.join("0.txt")).unwrap();
    fill(&disk.0, 1 << 20);
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Finish))],
    );
    // The test hears nothing in a pause.
    run(
        &mut app,
        &[(0, SimCommand::Clock(ClockCommand::SetPaused(false)))],
    );
    let (_, reason) = failure(&mut app);
    assert!(reason.contains("No space left"), "{reason}");
    assert_eq!(fs::read(demo.join("0.txt")).unwrap(), before);
    assert_eq!(fs::read_dir(demo.join("0")).unwrap().count(), 2);
    let session = Session::read(demo.join("session.jsonl")).unwrap();
    assert!(!session.is_finished());
}

#[test_with(Mounting)]
fn no_recording_starts_on_a_full_disk() {
    let place = Place::new();
    let disk = SmallDisk::mount(place.path().join("full"));
    fill(&disk.0, 1 << 20);
    let mut app = app_into(disk.0.join("demo"));
    run(
        &mut app,
        &[
            (0, scene(&IDS)),
            (0, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    let (folder, reason) = failure(&mut app);
    assert_eq!(folder, disk.0.join("demo"));
    assert!(reason.starts_with("no recording was started"), "{reason}");
    assert!(!disk.0.join("demo").exists(), "nothing is left of it");
    assert!(!app.world().resource::<Recording>().0);

    fs::remove_file(disk.0.join("filler")).unwrap();
    run(
        &mut app,
        &[(0, SimCommand::Recording(RecordingCommand::Start))],
    );
    assert!(app.world().resource::<Recording>().0, "there is space now");
}
