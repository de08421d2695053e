//! Every measurement is within its limit, but those that are known to fall short.
//!
//! Each experiment is a test, so `-- bounce --nocapture` carries out those whose names have `bounce` in them and prints their tables. Those that
//! take long are ignored by default.
#![expect(clippy::print_stdout, reason = "`--nocapture` prints the tables")]

use std::{collections::BTreeSet, process::ExitCode};

use libtest_mimic::{Arguments, Failed, Trial};
use tabletop_validation::{Experiment, experiments, table};

/// The names of the measurements that fall short. The list can only shrink: the test of an experiment fails, too, if one of these holds.
const SHORT: &[&str] = &[
    "roll-cylinder-4-degrees-damped: slip",
    "roll-cylinder-damped: change of height",
    "roll-cylinder: change of height",
    "roll-cylinder: speed aside",
    "roll-ball-4-degrees-damped: slip",
    "roll-ball-20-degrees-damped: slip",
    "roll-cylinder-20-degrees-damped: slip",
    "roll-small-ball: change of height",
    "roll-small-ball: speed",
    "roll-small-ball-damped: change of height",
    "roll-small-ball-damped: speed",
    "roll-ball: change of height",
    "roll-ball-damped: change of height",
    "roll-ball-damped: speed",
    "roll-cylinder-damped: speed",
    "tower-of-planks: drift",
    "tower-of-planks-awake: drift",
    "carry-gently: slip at a = 0.4 μ g",
    "carry-up-and-down: lift at a = 0.2 g",
    "bonds-beam-10-kg: sag",
];

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let prints = arguments.nocapture;
    let trials = experiments().map(|experiment| {
        let trial = Trial::test(experiment.name, move || holds(experiment, prints));
        trial.with_ignored_flag(experiment.is_long)
    });
    let trials = trials.chain([Trial::test("names are unique and known", names)]);
    libtest_mimic::run(&arguments, trials.collect()).exit_code()
}

/// Carries an experiment out.
fn holds(experiment: &Experiment, prints: bool) -> Result<(), Failed> {
    let measurements = experiment.measure();
    if prints {
        println!("\n{}", table(&measurements, None));
    }
    let mut faults = Vec::new();
    let mut quantities = BTreeSet::new();
    for measurement in &measurements {
        let name = measurement.name();
        if !quantities.insert(measurement.quantity) {
            faults.push(format!("{name} is not unique"));
        }
        match (measurement.holds(), SHORT.contains(&&*name)) {
            (false, false) => faults.push(format!("{name} falls short")),
            (true, true) => faults.push(format!("{name} holds: take it off the list SHORT")),
            (true, false) | (false, true) => {}
        }
    }
    match faults.is_empty() {
        true => Ok(()),
        false => {
            let table = table(&measurements, None);
            Err(format!("{}\n\n{table}", faults.join("\n")).into())
        }
    }
}

fn names() -> Result<(), Failed> {
    let mut names = BTreeSet::new();
    for experiment in experiments() {
        if !names.insert(experiment.name) {
            return Err(format!("two experiments are named {}", experiment.name).into());
        }
    }
    let known = |name: &&&str| {
        let experiment = name.split(':').next().unwrap_or_default();
        !names.contains(experiment)
    };
    match SHORT.iter().find(known) {
        Some(name) => Err(format!("SHORT has {name}, which there is not").into()),
        None => Ok(()),
    }
}
