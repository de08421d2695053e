//! `tabletop validate`: the physics beside closed-form results of mechanics.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    io::{self, Write as _},
    process::{Command, ExitCode, Stdio},
};

use crate::{
    run_episodes,
    validation::{Experiment, Measurement, Peer, chart, experiments, table},
};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::{
    Failure, Output,
    jobs::{JOBS, at_a_time},
    progress::ProgressLine,
    result_file::ResultKind,
    terminal::{say, show_warnings},
};

#[derive(Args)]
pub(super) struct ValidateArgs {
    /// The experiments, by the beginnings of their names, such as `bounce` or `seam-cube` [default: all but the long ones]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Carry out those, too, that take more than a few seconds
    #[arg(long)]
    long: bool,
    /// Write a chart of errors against limits as SVG; `-` is standard output
    #[arg(long, value_name = "FILE")]
    plot: Option<OsString>,
    /// Write the measurements as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<OsString>,
    /// Let another simulator carry out the same experiments, and give its errors beside ours
    #[arg(long, value_name = "SIMULATOR")]
    against: Option<PeerName>,
    /// A Python that has the other simulator (`pip install mujoco==3.9.0`) [default: python3]
    #[arg(long, value_name = "PROGRAM", requires = "against")]
    python: Option<OsString>,
    /// Number of experiments at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
}

#[derive(Clone, Copy, ValueEnum)]
enum PeerName {
    /// With its default options and a step of 0.002 s
    Mujoco,
}

/// The program that carries out the experiments in MuJoCo, and prints its measured values.
const MUJOCO: &str = include_str!("../../benches/peers/validate_mujoco.py");

/// Carries out the experiments. Exit code 1 if a measurement falls short.
pub(super) fn validate(args: &ValidateArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let chosen = args.experiments()?;
    let [plot, json] = [&args.plot, &args.json].map(|file| file.clone().map(Output::from));
    for (output, kind) in [(&plot, ResultKind::Svg), (&json, ResultKind::Json)] {
        output.iter().try_for_each(|output| output.check(kind))?;
    }
    let measurements = measure(&chosen, args.jobs)?;
    let peer = match args.against {
        Some(PeerName::Mujoco) => Some(ask_mujoco(args.python.as_ref(), &chosen)?),
        None => None,
    };
    if let Some(output) = &plot {
        output.write(chart(&measurements, peer.as_ref()).as_bytes())?;
    }
    if let Some(output) = &json {
        let rows: Vec<_> = measurements
            .iter()
            .map(|measurement| row(measurement, peer.as_ref()))
            .collect();
        output.write(format!("{:#}\n", json!(rows)).as_bytes())?;
    }
    let is_taken = [&plot, &json]
        .into_iter()
        .flatten()
        .any(|output| matches!(output, Output::Stdout));
    if !is_taken {
        Output::tell(&table(&measurements, peer.as_ref()))?;
    }
    let short = measurements.iter().filter(|it| !it.holds()).count();
    if short == 0 {
        return Ok(ExitCode::SUCCESS);
    }
    Err(Failure::run(format!(
        "{short} of {} measurements fall short of their limits",
        measurements.len()
    )))
}

impl ValidateArgs {
    fn experiments(&self) -> Result<Vec<&'static Experiment>, Failure> {
        for name in &self.names {
            if !experiments().any(|experiment| experiment.name.starts_with(name)) {
                let kind = |experiment: &Experiment| experiment.name.split('-').next();
                let mut kinds: Vec<_> = experiments().filter_map(kind).collect();
                kinds.dedup();
                return Err(Failure::input(format!(
                    "{name}: no experiment's name begins so; they begin with {}",
                    kinds.join(", ")
                )));
            }
        }
        let is_chosen = |experiment: &&Experiment| {
            let mut names = self.names.iter();
            let is_named = names.any(|name| experiment.name.starts_with(name));
            let is_exact = self.names.iter().any(|name| experiment.name == name);
            let is_short_enough = self.long || !experiment.is_long || is_exact;
            (self.names.is_empty() || is_named) && is_short_enough
        };
        Ok(experiments().filter(is_chosen).collect())
    }
}

/// Carries out experiments over the cores. Their measurements are in the order of the experiments.
fn measure(
    chosen: &[&'static Experiment],
    jobs: Option<usize>,
) -> Result<Vec<Measurement>, Failure> {
    let mut progress = ProgressLine::new(chosen.len() as u64, " experiments");
    let mut measurements = Vec::new();
    let run = |number: u64| Ok(chosen[number as usize].measure());
    run_episodes(
        0..chosen.len() as u64,
        at_a_time(jobs, chosen.len()),
        run,
        |number, measured| {
            progress.reach(number + 1, "");
            measurements.extend(measured);
            Ok::<_, Failure>(())
        },
    )?;
    progress.end();
    Ok(measurements)
}

fn row(measurement: &Measurement, peer: Option<&Peer>) -> Value {
    let mut row = json!({
        "name": measurement.name(),
        "experiment": measurement.experiment,
        "quantity": measurement.quantity,
        "formula": measurement.formula,
        "expected": measurement.expected,
        "measured": measurement.measured,
        "error": measurement.error(),
        "limit": measurement.tolerance,
        "holds": measurement.holds(),
    });
    if let Some(peer) = peer {
        row[&peer.name] = json!(peer.values.get(&measurement.name()));
    }
    row
}

/// MuJoCo's values of these experiments.
fn ask_mujoco(python: Option<&OsString>, chosen: &[&Experiment]) -> Result<Peer, Failure> {
    say("tabletop: MuJoCo carries out the experiments, too; all of them take some minutes");
    let usual = OsString::from(if cfg!(windows) { "python" } else { "python3" });
    let python = python.unwrap_or(&usual);
    let named = |error: String| {
        Failure::run(format!(
            "MuJoCo, by {}: {error}; name a Python that has it with --python (pip install mujoco==3.9.0)",
            python.display()
        ))
    };
    let failed = |error: io::Error| named(error.to_string());
    let mut process = Command::new(python)
        .arg("-")
        .args(chosen.iter().map(|experiment| experiment.name))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    if let Some(mut stdin) = process.stdin.take() {
        stdin.write_all(MUJOCO.as_bytes()).map_err(failed)?;
    }
    let output = process.wait_with_output().map_err(failed)?;
    if !output.status.success() {
        return Err(named(format!("it ended with {}", output.status)));
    }
    let values: BTreeMap<_, _> =
        serde_json::from_slice(&output.stdout).map_err(|error| named(error.to_string()))?;
    Ok(Peer {
        name: "MuJoCo".into(),
        values,
    })
}
