//! `tabletop run`: the simulation without a window.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use bevy::{app::PluginGroupBuilder, prelude::*};
use clap::Args;
use serde_json::json;
use tabletop::{
    TabletopSimPlugins,
    core::{SceneSpec, SimCommand, StepApp as _, TICKS_PER_SECOND},
    headless_app, headless_app_with,
    recorder::{RecorderPlugin, RehearsalPlugin},
    report,
    xml::read_task,
};
use tabletop_scenario::{Outcome, Program, Scenario, ScenarioPlugin, ScenarioRun};

use super::{Failure, Output, WRONG_INPUT};

#[derive(Args)]
pub(super) struct RunArgs {
    /// A scenario (see docs/scenarios.md): exit code 1 if one of its steps fails
    #[arg(value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
    /// The task file [default: tablesetup/default.xml, or the one that the scenario begins with]
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    /// How long to simulate, in seconds of simulated time; for a scenario the most that it may take [default: 10, or 600]
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Decides where a scenario places objects at random
    #[arg(
        long,
        value_name = "N",
        default_value = "0",
        requires = "scenario",
        hide_default_value = true
    )]
    seed: u64,
    /// Where a scenario's recordings are written; without it, nothing is recorded
    #[arg(long, value_name = "DIR", requires = "scenario")]
    record: Option<PathBuf>,
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
    match &args.scenario {
        Some(scenario) => perform(scenario, args),
        None => {
            let setup = args.setup.as_deref();
            let setup = setup.unwrap_or(Path::new(super::DEFAULT_SETUP));
            let seconds = args.seconds.unwrap_or(10.0);
            simulate(setup, seconds, args.final_state.as_ref())
        }
    }
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
    app.step(ticks(seconds));

    write_final_state(&app, final_state)?;
    Ok(match task.faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(WRONG_INPUT),
    })
}

/// Performs a scenario until it is done or has failed.
fn perform(scenario: &Path, args: &RunArgs) -> Result<ExitCode, Failure> {
    let mut scenario = Scenario::read(scenario).map_err(Failure::input)?;
    if let Some(setup) = &args.setup {
        scenario.begin_with(setup);
    }
    let mut program =
        Program::new(&scenario, read_faultless_task, args.seed).map_err(Failure::input)?;
    if let Some(seconds) = args.seconds {
        program.limit = ticks(seconds);
    }

    let mut app = headless_app_with((recording_plugins(args), ScenarioPlugin));
    app.insert_resource(ScenarioRun::new(program));
    let outcome = loop {
        app.step(1);
        match app.world().resource::<ScenarioRun>().outcome() {
            Outcome::Running => {}
            Outcome::Done => break Ok(ExitCode::SUCCESS),
            Outcome::Failed(error) => break Err(Failure::run(error)),
        }
    };
    write_final_state(&app, args.final_state.as_ref())?;
    outcome
}

/// The simulator, with a recorder if one is wanted.
fn recording_plugins(args: &RunArgs) -> PluginGroupBuilder {
    let plugins = TabletopSimPlugins.build();
    let Some(folder) = args.record.clone() else {
        return plugins.disable::<RecorderPlugin>().add(RehearsalPlugin);
    };
    let settings = [
        ("scenario".to_owned(), json!(args.scenario)),
        ("seed".to_owned(), json!(args.seed)),
    ];
    plugins.set(RecorderPlugin {
        folder,
        header: settings.into_iter().collect(),
        ..default()
    })
}

/// The scene of a task file, or everything that is wrong with it.
fn read_faultless_task(file: &Path) -> Result<SceneSpec, String> {
    let task = read_task(file).map_err(|error| error.to_string())?;
    let faults: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    match faults.is_empty() {
        true => Ok(task.scene),
        false => Err(faults.join("\n")),
    }
}

fn ticks(seconds: f64) -> u64 {
    (seconds * f64::from(TICKS_PER_SECOND)).round() as u64
}

fn write_final_state(app: &App, output: Option<&Output>) -> Result<(), Failure> {
    let Some(output) = output else {
        return Ok(());
    };
    let mut csv = Vec::new();
    report::write_state(app.world(), &mut csv).map_err(Failure::run)?;
    output.write(&csv)
}
