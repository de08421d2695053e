//! `tabletop multiply`: one demonstration becomes many.

use std::{collections::BTreeMap, fmt, path::PathBuf, process::ExitCode, time::Instant};

use crate::{
    Collection, CollectionError,
    multiplication::{Made, Multiplication, Variation},
    recorder::{RecordingReader, SessionHeader, read_original},
    run_episodes,
    shipped::read_faultless_task,
};
use clap::{
    Args,
    builder::{PathBufValueParser, TypedValueParser as _},
};
use serde_json::{Value, json};

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    cut_off::say_if_cut_off,
    hand_cameras::HandCameraOption,
    jobs::{JOBS, at_a_time},
    progress::ProgressLine,
    range::{NumberRange, SEEDS},
    result_file::require_outside,
    robot_options::robot_of,
    shard::ShardOption,
    terminal::{say, show_warnings},
    variation_options::VariationOptions,
    wait::WaitOption,
};

#[derive(Args)]
#[command(mut_group("HandCameraOption", |options| options.requires("robot")))]
pub(super) struct MultiplyArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// Number of demonstrations to make, from 1 to 1000000
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = COUNTS, allow_negative_numbers = true)]
    count: u64,
    /// The folder for them, each in a folder of its number; existing ones are kept
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The seed of places and all other differences, from 0 to 18446744073709551615 [default: 0]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = SEEDS, allow_negative_numbers = true)]
    seed: u64,
    /// Let the robot demonstrate instead of the hand: the Baxter inside the program, or the one of this robot.ron (docs/robot.md), or of a URDF
    /// with the same joints. The recording comes before this option
    #[arg(long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(no_folder))]
    robot: Option<Option<PathBuf>>,
    #[command(flatten)]
    variation: VariationOptions,
    /// Keep all that the task moves in the head camera's picture
    #[arg(long)]
    in_view: bool,
    /// The task file with the objects to do it with [default: the scene of the recording]
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
    #[command(flatten)]
    hand_cameras: HandCameraOption,
    #[command(flatten)]
    shard: ShardOption,
    /// Number of demonstrations made at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
    #[command(flatten)]
    wait: WaitOption,
}

const COUNTS: NumberRange<u64> = NumberRange::whole(1, 1_000_000);

/// The file with what a folder of demonstrations is made of.
const MANIFEST: &str = "multiply.json";

/// Refuses a folder as a robot's file: it is the recording.
fn no_folder(file: PathBuf) -> Result<PathBuf, &'static str> {
    match file.is_dir() {
        true => Err("it is a folder, not a robot; a recording comes before --robot"),
        false => Ok(file),
    }
}

/// Makes the demonstrations. Exit code 1 if some could not be made.
pub(super) fn run(args: &MultiplyArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    require_outside(&args.out, &[&args.recording])?;
    let robot = match &args.robot {
        Some(file) => Some(robot_of(file.as_deref())?),
        None => None,
    };
    let variation = Variation {
        in_view: args.in_view,
        ..args.variation.variation()
    };
    let robot_or_baxter = robot.clone().unwrap_or_default();
    let hand_pictures = args.hand_cameras.of(&robot_or_baxter)?;
    let scene = match &args.setup {
        Some(setup) => {
            Some(read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?)
        }
        None => None,
    };
    let original = read_original(&args.recording).map_err(Failure::input)?;
    let multiplication = match (original, scene) {
        (Some(_), None) => {
            return Err(Failure::input(
                "the recording does not say which scene it began with; name one with --setup",
            ));
        }
        (Some(_), Some(scene)) => {
            Multiplication::of_events(&args.recording, scene, robot, variation, args.seed)
                .map_err(Failure::input)?
        }
        (None, scene) => {
            let recording = RecordingReader::open(&args.recording).map_err(Failure::input)?;
            say_if_cut_off(&recording, "multiplied");
            let multiplication = Multiplication::of(&recording, robot, variation, args.seed)
                .map_err(Failure::input)?;
            match scene {
                Some(scene) => multiplication.with_scene(scene).map_err(Failure::run)?,
                None => multiplication,
            }
        }
    };
    let multiplication = multiplication.with_hand_pictures(hand_pictures);
    let manifest = args.manifest(&multiplication);
    let storage = args.wait.storage();
    let collection = Collection::open(&args.out, MANIFEST, &manifest, &storage);
    let collection = collection.map_err(refused)?;
    let start = Instant::now();
    let mut missing = Vec::new();
    let mut there = 0;
    for number in args.shard.share_of(0..args.count) {
        let is_right = |header: &SessionHeader| multiplication.has_made(number, header);
        match collection.holds(number, is_right).map_err(refused)? {
            true => there += 1,
            false => missing.push(number),
        }
    }
    let outcome = make_all(args, &multiplication, &collection, &missing);
    let closed = collection.close().map_err(refused);
    let outcome = outcome?;
    closed?;
    let real = start.elapsed().as_secs_f64();
    Output::tell(&outcome.summary(there, real))?;
    Ok(ExitCode::from(u8::from(!outcome.given_up.is_empty())))
}

/// The failure of a folder that takes no recordings.
pub(super) fn refused(error: CollectionError) -> Failure {
    match error {
        CollectionError::Io { .. } => Failure::run(error),
        CollectionError::OtherManifest(_)
        | CollectionError::SomethingElse(_)
        | CollectionError::NoMember(_) => Failure::input(error),
    }
}

/// The results of all demonstrations.
#[derive(Default)]
struct Tally {
    made: u64,
    dropped: BTreeMap<String, u64>,
    given_up: Vec<u64>,
}

impl Tally {
    fn note(&mut self, number: u64, made: &Made) {
        match made.is_kept {
            true => self.made += 1,
            false => self.given_up.push(number),
        }
        for reason in &made.dropped {
            *self.dropped.entry(reason.to_string()).or_default() += 1;
        }
    }

    /// The number of dropped demonstrations, for the progress line.
    fn dropped_note(&self) -> String {
        match self.dropped.values().sum::<u64>() {
            0 => String::new(),
            dropped => format!(", {dropped} dropped"),
        }
    }

    fn summary(&self, there: u64, real: f64) -> String {
        let mut lines = Vec::new();
        if there > 0 {
            lines.push(format!("{there} were there"));
        }
        let rate = self.made as f64 / real.max(1e-3);
        lines.push(format!(
            "{} made in {real:.1} s: {rate:.1} a second",
            self.made
        ));
        let dropped: u64 = self.dropped.values().sum();
        if dropped > 0 {
            lines.push(format!("{dropped} dropped and tried elsewhere:"));
            let reasons = self.dropped.iter();
            lines.extend(reasons.map(|(reason, count)| format!("{count:>6}  {reason}")));
        }
        if !self.given_up.is_empty() {
            let numbers: Vec<_> = self.given_up.iter().map(u64::to_string).collect();
            lines.push(format!("given up: {}", numbers.join(", ")));
        }
        lines.join("\n") + "\n"
    }
}

/// Makes demonstrations on all cores. The first error ends it.
fn make_all(
    args: &MultiplyArgs,
    multiplication: &Multiplication,
    collection: &Collection,
    missing: &[u64],
) -> Result<Tally, Failure> {
    let jobs = at_a_time(args.jobs, missing.len());
    let make = |number| make(multiplication, collection, number);
    let mut progress = ProgressLine::new(missing.len() as u64, "");
    let mut done = 0;
    let mut outcome = Tally::default();
    let result = run_episodes(missing.iter().copied(), jobs, make, |number, made| {
        outcome.note(number, &made);
        done += 1;
        progress.reach(done, &outcome.dropped_note());
        Ok(())
    });
    progress.end();
    result?;
    for number in &outcome.given_up {
        say(format_args!(
            "tabletop: demonstration {number} could not be made"
        ));
    }
    Ok(outcome)
}

/// Makes one, which appears when it is complete.
fn make(
    multiplication: &Multiplication,
    collection: &Collection,
    number: u64,
) -> Result<Made, Failure> {
    let made = multiplication.make(number, &collection.part(number));
    let made = made.map_err(|error| Failure::run(named(number, &error)))?;
    if made.is_kept {
        let kept = collection.keep(number);
        kept.map_err(|error| Failure::run(named(number, &error)))?;
    }
    Ok(made)
}

impl MultiplyArgs {
    /// All that decides the demonstrations, but not their number.
    fn manifest(&self, multiplication: &Multiplication) -> Value {
        json!({
            "made_of": multiplication.fingerprint(),
            "program": env!("CARGO_PKG_VERSION"),
            "seed": self.seed,
            "robot": self.robot.is_some(),
            "colors": self.variation.colors,
            "sizes": self.variation.sizes,
            "distractors": self.variation.distractors,
            "camera": self.variation.camera,
            "light": self.variation.light,
            "in_view": self.in_view,
            "hand_cameras": self.hand_cameras.hand_cameras,
        })
    }
}

fn named(number: u64, error: &impl fmt::Display) -> String {
    format!("demonstration {number}: {error}")
}
