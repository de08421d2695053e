//! `tabletop run`: the simulation without a window.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::Args;
use tabletop::{
    core::{SimCommand, StepApp as _, TICKS_PER_SECOND},
    headless_app, report,
    xml::read_task,
};

use super::{Failure, Output, WRONG_INPUT};

#[derive(Args)]
pub(super) struct RunArgs {
    /// The task file
    #[arg(long, value_name = "FILE", default_value = super::DEFAULT_SETUP)]
    setup: PathBuf,
    /// How long to simulate, in seconds of simulated time
    #[arg(long, value_name = "S", default_value = "10", value_parser = seconds)]
    seconds: f64,
    /// Write where every object is in the end, as CSV (`id,x,y,z,rx,ry,rz`); `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    final_state: Option<Output>,
}

/// Reads a time of 0 to a year.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    const YEAR: f64 = 366.0 * 24.0 * 3600.0;
    text.parse()
        .ok()
        .filter(|seconds| (0.0..=YEAR).contains(seconds))
        .ok_or_else(|| format!("expected a number of seconds from 0 to {YEAR}"))
}

pub(super) fn run(args: &RunArgs) -> Result<ExitCode, Failure> {
    simulate(&args.setup, args.seconds, args.final_state.as_ref())
}

/// Simulates a task file for so many seconds. Its faults are reported and do not stop the run, but give exit code 2.
pub(super) fn simulate(
    setup: &Path,
    seconds: f64,
    final_state: Option<&Output>,
) -> Result<ExitCode, Failure> {
    let task = read_task(setup).map_err(Failure::input)?;
    for fault in &task.faults {
        eprintln!("{fault}");
    }

    let mut app = headless_app();
    app.world_mut()
        .write_message(SimCommand::SetScene(Box::new(task.scene)));
    app.step((seconds * f64::from(TICKS_PER_SECOND)).round() as u64);

    if let Some(output) = final_state {
        let mut csv = Vec::new();
        report::write_state(app.world(), &mut csv).map_err(Failure::run)?;
        output.write(&csv)?;
    }
    Ok(match task.faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(WRONG_INPUT),
    })
}
