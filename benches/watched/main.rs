//! How far the events that `tabletop watch` reconstructs from pictures can be trusted when the pictures are not as the simulator draws them.
//!
//! `cargo bench --bench watched -- [KIND] [COUNT]` makes demonstrations of six tasks, makes their pictures worse in each way, or in those whose names begin with KIND,
//! lets the program watch COUNT (100) of them, and counts how many are right, how many are said to be unsure, and how many are wrong in silence. Right are the
//! sentences of `tabletop explain`, with exit code 0; said to be unsure is everything with exit code 1. A robot's recording has no acts of hands to explain; right
//! is then what follows from the true poses at the pictures. `VERBOSE=1` prints what is said of each.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

mod degraded;
mod jpeg;
mod stranger;

use std::{
    collections::BTreeMap,
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    time::Instant,
};

use degraded::Degradation;
use serde_json::Value;
use stranger::with_stranger;
use tabletop::{
    core::{ObjectSpec, SimTick},
    film::Canvas,
    multiplication::{Multiplication, Variation},
    recorder::{RecordingReader, read_picture},
    robot::RobotPlugin,
    task::{Demonstration, Requirements, Task, Track},
};

const TASKS: [&str; 6] = ["stack_three", "swap", "wall", "letter_u", "hanoi", "chest"];
const COUNT: usize = 100;

/// How demonstrations are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Making {
    Plain,
    Colors,
    Light,
    Distractors,
    /// The robot demonstrates, in the picture.
    Robot,
}

/// What the pictures of demonstrations are like.
struct Kind {
    name: &'static str,
    making: Making,
    degradation: Degradation,
    has_stranger: bool,
}

const PLAIN: Kind = Kind {
    name: "as drawn",
    making: Making::Plain,
    degradation: Degradation::None,
    has_stranger: false,
};

const KINDS: [Kind; 15] = [
    PLAIN,
    Kind {
        name: "JPEG 99, colours at half resolution",
        degradation: Degradation::Jpeg(99.0),
        ..PLAIN
    },
    Kind {
        name: "JPEG 80, colours at half resolution",
        degradation: Degradation::Jpeg(80.0),
        ..PLAIN
    },
    Kind {
        name: "rescaled twice around JPEG 85",
        degradation: Degradation::Rescaled,
        ..PLAIN
    },
    Kind {
        name: "blur of 0.7 pixels",
        degradation: Degradation::Blur(0.7),
        ..PLAIN
    },
    Kind {
        name: "brightness × 0.7",
        degradation: Degradation::Brightness(0.7, 0.0),
        ..PLAIN
    },
    Kind {
        name: "brightness × 1.2",
        degradation: Degradation::Brightness(1.2, 0.0),
        ..PLAIN
    },
    Kind {
        name: "contrast × 0.8, 25 grey levels brighter",
        degradation: Degradation::Brightness(0.8, 25.0),
        ..PLAIN
    },
    Kind {
        name: "noise of 6 grey levels",
        degradation: Degradation::Noise(6.0),
        ..PLAIN
    },
    Kind {
        name: "stranger in the colour of an object",
        has_stranger: true,
        ..PLAIN
    },
    Kind {
        name: "multiply --colors",
        making: Making::Colors,
        ..PLAIN
    },
    Kind {
        name: "multiply --light 0.3",
        making: Making::Light,
        ..PLAIN
    },
    Kind {
        name: "multiply --distractors 4",
        making: Making::Distractors,
        ..PLAIN
    },
    Kind {
        name: "multiply --robot",
        making: Making::Robot,
        ..PLAIN
    },
    Kind {
        name: "multiply --robot, JPEG 99",
        making: Making::Robot,
        degradation: Degradation::Jpeg(99.0),
        ..PLAIN
    },
];

/// What became of the demonstrations of a kind.
#[derive(Default)]
struct Tally {
    right: usize,
    unsure: usize,
    /// Of those that are said to be unsure, how many have the right sentences.
    doubted: usize,
    silent: Vec<String>,
    slowest: f64,
}

fn main() {
    let arguments = env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with("--"));
    let (counts, names): (Vec<_>, Vec<_>) =
        arguments.partition(|argument| argument.parse::<usize>().is_ok());
    let count = counts
        .first()
        .map_or(COUNT, |count| count.parse().unwrap_or(COUNT));
    let is_asked =
        |kind: &&Kind| names.is_empty() || names.iter().any(|name| kind.name.starts_with(name));
    let folder = env::temp_dir().join(format!("tabletop_watched_{}", std::process::id()));
    let mut made = Demonstrations::new(&folder);
    println!(
        "| pictures | right | said unsure (right all the same) | wrong in silence | slowest |"
    );
    println!("|---|---|---|---|---|");
    for kind in KINDS.iter().filter(is_asked) {
        let mut tally = Tally::default();
        for number in 0..count {
            let demonstration = made.get(kind.making, number);
            tally.add(kind, number, &demonstration, &folder.join("degraded"));
        }
        let Tally {
            right,
            unsure,
            doubted,
            silent,
            slowest,
        } = tally;
        let wrong = silent.len();
        println!(
            "| {} | {right} | {unsure} ({doubted}) | {wrong} | {slowest:.1} s |",
            kind.name
        );
        for which in silent {
            println!("    {which}");
        }
    }
    fs::remove_dir_all(folder).unwrap();
}

impl Tally {
    fn add(&mut self, kind: &Kind, number: usize, demonstration: &Path, degraded: &Path) {
        degrade(kind, number, demonstration, degraded);
        let told = match kind.making {
            Making::Robot => task_by_poses(demonstration),
            Making::Plain | Making::Colors | Making::Light | Making::Distractors => {
                let explain = ["explain", "--json", demonstration.to_str().unwrap()];
                task_of(&program(&explain))
            }
        };
        let start = Instant::now();
        let output = program(&["watch", "--json", degraded.to_str().unwrap()]);
        self.slowest = self.slowest.max(start.elapsed().as_secs_f64());
        let task = task_of(&output);
        let is_right = sentences(&task) == sentences(&told);
        let name = format!("{} {}", TASKS[number % TASKS.len()], number / TASKS.len());
        match (output.status.code(), is_right) {
            (Some(0), true) => self.right += 1,
            (Some(1), _) => {
                self.unsure += 1;
                self.doubted += usize::from(is_right);
            }
            _ => self.silent.push(name.clone()),
        }
        if env::var_os("VERBOSE").is_some() {
            let code = output.status.code();
            println!(
                "{} {name}: {code:?} {is_right} {:#?}",
                kind.name,
                sentences(&task)
            );
        }
    }
}

/// Demonstrations that were made.
struct Demonstrations {
    folder: PathBuf,
    multiplications: BTreeMap<(Making, usize), Multiplication>,
}

impl Demonstrations {
    fn new(folder: &Path) -> Self {
        fs::create_dir_all(folder).unwrap();
        Self {
            folder: folder.to_owned(),
            multiplications: BTreeMap::new(),
        }
    }

    /// The folder of the demonstration of this number.
    fn get(&mut self, making: Making, number: usize) -> PathBuf {
        let task = number % TASKS.len();
        let folder = self.folder.join(format!("{making:?}_{number}"));
        if folder.exists() {
            return folder;
        }
        let shown = self.folder.join(TASKS[task]);
        let multiplication = self
            .multiplications
            .entry((making, task))
            .or_insert_with(|| {
                if !shown.exists() {
                    let scenario = format!("shipped:scenarios/{}.ron", TASKS[task]);
                    let record = ["run", &scenario, "--quiet", "--record"];
                    let output = program(&[&record[..], &[shown.to_str().unwrap()]].concat());
                    assert!(output.status.success(), "{output:?}");
                }
                making.multiplication(&RecordingReader::open(&shown).unwrap())
            });
        // Rarely none can be made at a number; those far beyond the last one take its place.
        let mut numbers = (0..10).map(|next| (number / TASKS.len() + 1000 * next) as u64);
        let is_made = numbers.any(|number| multiplication.make(number, &folder).unwrap().is_kept);
        assert!(is_made, "{making:?} {number} cannot be made");
        folder
    }
}

impl Making {
    fn multiplication(self, recording: &RecordingReader) -> Multiplication {
        let robot = (self == Self::Robot).then(RobotPlugin::default);
        let variation = Variation {
            in_view: true,
            colors: self == Self::Colors,
            light: if self == Self::Light { 0.3 } else { 0.0 },
            distractors: if self == Self::Distractors { 4 } else { 0 },
            ..Variation::default()
        };
        Multiplication::of(recording, robot, variation, 1).unwrap()
    }
}

/// The task that follows from the true poses at the pictures of a recording.
fn task_by_poses(recording: &Path) -> Value {
    let reader = RecordingReader::open(recording).unwrap();
    let scene = &reader.session().scene;
    let (rows, begin) = (reader.states().unwrap(), reader.first_tick().0);
    let segments = reader.segments().unwrap().into_iter();
    let ticks: Vec<_> = segments
        .flat_map(|segment| segment.frames)
        .map(|frame| frame.tick)
        .collect();
    let objects = scene.objects.iter().map(|object| {
        let spec = ObjectSpec {
            pose: object.pose,
            ..object.spec.clone()
        };
        let mut track = Track::default();
        let mut last = spec.pose;
        track.push(SimTick(0), last);
        for tick in &ticks {
            let until = rows.iter().take_while(|row| row.tick <= *tick);
            let own = until.filter(|row| row.id == spec.id).last();
            let pose = own.map_or(spec.pose, |row| row.pose);
            if pose != last {
                track.push(SimTick(tick.0 - begin), pose);
                last = pose;
            }
        }
        (spec, track)
    });
    let end = ticks.last().map_or(0, |tick| tick.0 - begin);
    let shown = Demonstration::of_motions(
        scene.table.unwrap_or_default(),
        objects.collect::<Vec<_>>(),
        scene.joints.clone(),
        SimTick(end),
    );
    let mut task = Task::of(&shown);
    task.phrase(&Requirements::default());
    serde_json::to_value(&task).unwrap()
}

/// Copies a recording with its pictures made worse.
fn degrade(kind: &Kind, number: usize, recording: &Path, out: &Path) {
    if out.exists() {
        fs::remove_dir_all(out).unwrap();
    }
    copy(recording, out);
    let reader = RecordingReader::open(recording).unwrap();
    let stranger = kind
        .has_stranger
        .then(|| with_stranger(&reader, number as u64));
    let frames = reader.segments().unwrap().into_iter();
    for (frame, serial) in frames.flat_map(|segment| segment.frames).zip(0..) {
        let picture = match &stranger {
            Some(stranger) => stranger.picture(frame.tick),
            None => read_picture(&frame.picture).unwrap(),
        };
        let picture = kind.degradation.of(&picture, 1000 * number as u64 + serial);
        let path = frame.picture.path();
        let own = out.join(path.strip_prefix(recording).unwrap());
        fs::write(own, Canvas::of(&picture).png().unwrap()).unwrap();
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let own = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &own),
            false => {
                fs::copy(&path, own).unwrap();
            }
        }
    }
}

/// The task that a command prints.
fn task_of(output: &Output) -> Value {
    let json: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    json["task"].clone()
}

/// The sentences of a task, with their order.
fn sentences(task: &Value) -> Vec<String> {
    let all = |name: &str| task[name].as_array().cloned().unwrap_or_default();
    let steps = all("steps").into_iter().chain(all("pushes"));
    let sentences = steps.map(|step| {
        let [number, after, sentence] = ["number", "after", "sentence"].map(|name| &step[name]);
        format!("{number} {after} {sentence}")
    });
    sentences.collect()
}

fn program(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_tabletop"));
    program
        .args(arguments)
        .env_remove("DISPLAY")
        .output()
        .unwrap()
}
