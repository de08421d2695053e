//! `tabletop import`: recordings of the original program as recordings of this one.

use std::{path::PathBuf, process::ExitCode};

use crate::dataset::{DatasetError, Import, import_recording};
use clap::Args;

use crate::shipped::read_faultless_task;

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    counted::counted,
    recorded::say_moved_aside,
    result_file::require_outside,
    terminal::{say, show_warnings},
};

#[derive(Args)]
pub(super) struct ImportArgs {
    /// The folder of the original recording: 0.txt, 1.txt, … and pictures, if there are any
    #[arg(value_name = "SRC")]
    source: PathBuf,
    /// The folder of the new recording
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The task file that was on the table: it tells sizes, joints and parts that the recording does not
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
}

/// Number of remarks that are printed, at most.
const MOST_REMARKS: usize = 20;

/// Imports a recording.
pub(super) fn run(args: &ImportArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    require_outside(&args.out, &[&args.source])?;
    let setup = match &args.setup {
        Some(setup) => {
            Some(read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?)
        }
        None => None,
    };
    let import = import_recording(&args.source, &args.out, setup.as_ref()).map_err(failed)?;
    for remark in import.remarks.iter().take(MOST_REMARKS) {
        say(format_args!("tabletop: {remark}"));
    }
    let more = import.remarks.len().saturating_sub(MOST_REMARKS);
    if more > 0 {
        say(format_args!("tabletop: {more} more remarks of this kind"));
    }
    Output::tell(&reported(&import))?;
    say_moved_aside(&import.report.moved_aside);
    Ok(ExitCode::SUCCESS)
}

pub(super) fn failed(error: DatasetError) -> Failure {
    match error.is_of_input() {
        true => Failure::input(error),
        false => Failure::run(error),
    }
}

fn reported(import: &Import) -> String {
    let Import {
        segments,
        last_frame,
        objects,
        recorded_pictures,
        drawn_pictures,
        acts,
        remarks: _,
        report: _,
    } = import;
    let seconds = *last_frame as f64 / 4.0;
    let acts = acts.name();
    format!(
        "{}, {seconds} s, {}; {} taken over, {drawn_pictures} drawn; acts of hands {acts}.\n",
        counted(*segments, "segment"),
        counted(*objects, "object"),
        counted(*recorded_pictures, "picture")
    )
}
