//! `tabletop edit`: a recording of another's segments.

use std::{collections::BTreeSet, ops::RangeInclusive, path::PathBuf, process::ExitCode};

use crate::{
    recorder::{RecorderPlugin, whole_recording},
    replay::{Replay, SegmentEdit},
    storage::Storage,
    task::Requirements,
};
use bevy::prelude::default;
use clap::Args;

use super::{
    Failure,
    allowed_paths::AllowedPaths,
    cut_off::say_if_cut_off,
    number_run::run_of,
    quiet::QuietOption,
    range::NumberRange,
    recorded::say_moved_aside,
    result_file::require_outside,
    terminal::{say, show_warnings},
};

/// Numbers of segments.
const SEGMENTS: NumberRange<u32> = NumberRange::whole(0, u32::MAX);
/// Factors of a segment's time.
const FACTORS: NumberRange<f64> = NumberRange::decimal(0.01, 100.0);

#[derive(Args)]
pub(super) struct EditArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// The folder of the new recording
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// Leave out segments: their numbers, such as 3 or 3,5-6
    #[arg(long, value_name = "N,…", value_parser = numbers)]
    drop: Option<SegmentNumbers>,
    /// Let two segments change places, or two runs of them, such as 1-2,3-4
    #[arg(long, value_name = "N,M", value_parser = swap)]
    swap: Vec<Swap>,
    /// Let a segment take so many times its time, from 0.01 to 100, such as 2=0.5
    #[arg(long, value_name = "N=FACTOR", value_parser = retime)]
    retime: Vec<Retime>,
    /// Append the segments of another recording
    #[arg(long, value_name = "DIR")]
    splice: Vec<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
    #[command(flatten)]
    quiet: QuietOption,
}

/// Numbers of segments.
#[derive(Clone, Debug)]
struct SegmentNumbers(BTreeSet<u32>);

type Swap = (RangeInclusive<u32>, RangeInclusive<u32>);
type Retime = (u32, f64);

/// Records the edited recording.
pub(super) fn run(args: &EditArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    require_outside(&args.out, &[&args.recording])?;
    let replay = Replay::read_allowing(&args.recording, &args.allowed.folders);
    let replay = replay.map_err(Failure::input)?;
    say_if_cut_off(replay.recording(), "edited");
    let mut edits = Vec::new();
    let dropped = args.drop.iter();
    edits.extend(dropped.map(|numbers| SegmentEdit::Drop(numbers.0.clone())));
    let swapped = args.swap.iter().cloned();
    edits.extend(swapped.map(|(one, other)| SegmentEdit::Swap(one, other)));
    let retimed = args.retime.iter();
    edits.extend(retimed.map(|&(number, factor)| SegmentEdit::Retime(number, factor)));
    for other in &args.splice {
        let other = Replay::read_allowing(other, &args.allowed.folders);
        edits.push(SegmentEdit::Splice(Box::new(
            other.map_err(Failure::input)?,
        )));
    }
    if edits.is_empty() {
        return Err(Failure::input(
            "nothing to edit; expected --drop, --swap, --retime or --splice",
        ));
    }
    let edited = replay.edited(&edits).map_err(Failure::run)?;
    let (_, moved_aside) = whole_recording(&args.out, &Storage::default(), |folder| {
        let recorder = RecorderPlugin {
            folder: folder.to_owned(),
            ..default()
        };
        let recorded = edited.record(recorder, replay.camera());
        recorded.map_err(Failure::run)
    })?;
    args.quiet.sum_up_recording(&args.out);
    say_moved_aside(&moved_aside);
    let requirements = args.recording.join(Requirements::FILE);
    if requirements.exists() {
        say(format_args!(
            "tabletop: {}: these requirements are not taken over, as the edited recording may have other roles; tabletop require sets its own",
            requirements.display()
        ));
    }
    Ok(ExitCode::SUCCESS)
}

/// Reads numbers and runs, such as `3,5-6`.
fn numbers(text: &str) -> Result<SegmentNumbers, String> {
    let runs: Result<Vec<_>, _> = text.split(',').map(run_of).collect();
    let runs = runs.map_err(|_| "expected their numbers, such as 3 or 3,5-6")?;
    Ok(SegmentNumbers(runs.into_iter().flatten().collect()))
}

fn swap(text: &str) -> Result<Swap, String> {
    let runs = text.split_once(',');
    let (one, other) =
        runs.ok_or("expected two segments or runs of them, such as 1,2 or 1-2,3-4")?;
    Ok((run_of(one)?, run_of(other)?))
}

fn retime(text: &str) -> Result<Retime, String> {
    let parts = text.split_once('=');
    let (number, factor) = parts.ok_or("expected a segment and a factor, such as 2=0.5")?;
    Ok((SEGMENTS.read(number)?, FACTORS.read(factor)?))
}
