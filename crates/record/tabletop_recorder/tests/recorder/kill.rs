//! A program that is killed leaves its recording complete up to its last tick.

use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead as _, BufReader, Write as _},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use tabletop_core::{Hand, HandCommand, RecordingCommand, SimCommand, SimTick};
use tabletop_recorder::{Session, whole_lines};

use crate::stage::{Place, app_into, grasp, run, scene};

const FOLDER: &str = "TABLETOP_RECORDER_KILL_FOLDER";
const IDS: [&str; 4] = ["a", "bb", "ccc", "dddd"];

#[test]
#[ignore = "runs until it is killed: the program that the other test starts"]
fn records_until_killed() {
    let Some(folder) = std::env::var_os(FOLDER) else {
        return;
    };
    let mut app = app_into(PathBuf::from(folder));
    run(
        &mut app,
        &[
            (0, scene(&IDS)),
            (0, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    let mut out = std::io::stdout();
    for tick in 1_u64.. {
        let command = match tick % 40 {
            0 => grasp(Hand::Left, "a"),
            20 => SimCommand::Hand(HandCommand::Release(Hand::Left)),
            _ => SimCommand::Hand(HandCommand::Select(Hand::Left)),
        };
        run(&mut app, &[(0, command)]);
        assert_eq!(app.world().resource::<SimTick>().0, tick + 1);
        writeln!(out, "\ntick {tick}").unwrap();
    }
}

#[test]
fn a_recording_is_complete_up_to_a_kill() {
    let place = Place::new();
    let begin = Instant::now();
    for round in 0..15 {
        let demo = place.path().join(round.to_string());
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args([
                "--exact",
                "kill::records_until_killed",
                "--ignored",
                "--nocapture",
            ])
            .env(FOLDER, &demo)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let tick_of = |line: &str| {
            line.strip_prefix("tick ")
                .and_then(|tick| tick.parse().ok())
        };
        let mut last: u64 = lines
            .by_ref()
            .find_map(|line| tick_of(&line.unwrap()))
            .expect("no tick was recorded");
        // Somewhere within a tick: which part of it, the clock decides.
        let reading = thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                last = tick_of(&line).unwrap_or(last);
            }
            last
        });
        let nanos = begin.elapsed().subsec_nanos() % 100_000_000;
        thread::sleep(Duration::from_nanos(u64::from(nanos)));
        child.kill().unwrap();
        child.wait().unwrap();
        check_recording(&demo, reading.join().unwrap());
    }
}

/// The text of a file up to its last line end.
fn read_whole_lines(path: &Path) -> String {
    String::from_utf8(whole_lines(&fs::read(path).unwrap()).to_vec()).unwrap()
}

fn check_recording(demo: &Path, last: u64) {
    let states = read_whole_lines(&demo.join("states.csv"));
    let mut seen: BTreeMap<u64, Vec<String>> = BTreeMap::new();
    for row in csv::Reader::from_reader(states.as_bytes()).records() {
        let row = row.unwrap();
        assert_eq!(row.len(), 15);
        let tick = row[0].parse().unwrap();
        seen.entry(tick).or_default().push(row[1].to_owned());
    }
    for tick in 0..=last {
        assert_eq!(seen[&tick], IDS, "tick {tick} of {last}");
    }

    let session = Session::read(demo.join("session.jsonl")).unwrap();
    let ticks: Vec<_> = session.commands.iter().map(|line| line.tick).collect();
    // Tick 0 has two: the scene is set before the recording is started.
    assert!(ticks.len() as u64 > last, "{last} {}", ticks.len());
    assert!(ticks.is_sorted());
    assert!(!session.is_finished());
    let end = session.last_tick(demo).unwrap().0;
    assert!((last..=last + 1).contains(&end), "{end}, {last}");

    let mut frames = Vec::new();
    for segment in 0.. {
        let path = demo.join(format!("{segment}.txt"));
        if !path.exists() {
            break;
        }
        for line in read_whole_lines(&path).lines() {
            let fields: Vec<_> = line.split(',').collect();
            let frame: u64 = fields[0].parse().unwrap();
            if fields[1] != "move" {
                continue;
            }
            assert_eq!(fields.len(), 9, "{line}");
            if frames.last() != Some(&frame) {
                frames.push(frame);
            }
            let picture = demo.join(format!("{segment}/{frame}.png"));
            let file = BufReader::new(fs::File::open(picture).unwrap());
            let mut reader = png::Decoder::new(file).read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
        }
    }
    let expected: Vec<u64> = (0..=last / 15).collect();
    assert!(frames.starts_with(&expected), "{frames:?} {last}");
    assert!(frames.len() <= expected.len() + 1);
}
