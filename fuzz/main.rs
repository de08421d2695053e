//! Feeds the readers of files, and the simulator, with inputs that nobody would write, and keeps the harmful ones. `fuzz/README.md`
//! describes its use and its results.
//!
//! An input follows from its target, a seed and its number alone, so nothing but these need be kept.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it says what it finds"
)]

mod input;
mod mutation;
mod scenes;
mod sets;
mod supervisor;
mod target;

use std::{env, process::ExitCode, time::Duration};

use crate::{input::Inputs, supervisor::Supervisor, target::Target};

/// The option of a process that tries inputs.
const WORK: &str = "--work";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let result = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [WORK, target, seed, first, count, progress] => {
            supervisor::work(target, [seed, first, count], progress)
        }
        ["show", target, seed, number] => show(target, seed, number),
        ["try", target, file] => try_file(target, file),
        [target, seed, minutes] => search(target, seed, minutes),
        _ => Err(format!(
            "usage: fuzz TARGET SEED MINUTES | fuzz show TARGET SEED NUMBER | fuzz try TARGET FILE\ntargets: {}",
            Target::ALL.map(|target| target.name).join(" ")
        )),
    };
    match result {
        Ok(code) => code,
        Err(problem) => {
            eprintln!("fuzz: {problem}");
            ExitCode::from(2)
        }
    }
}

/// Tries inputs for this many minutes, and keeps the harmful ones.
fn search(target: &str, seed: &str, minutes: &str) -> Result<ExitCode, String> {
    let target = Target::named(target)?;
    let minutes: f64 = number(minutes)?;
    let limit = Duration::try_from_secs_f64(minutes * 60.0).map_err(|error| error.to_string())?;
    let found = Supervisor::new(target, number(seed)?)?.run(limit)?;
    Ok(match found {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    })
}

/// Writes an input to standard output.
fn show(target: &str, seed: &str, input: &str) -> Result<ExitCode, String> {
    use std::io::Write as _;
    let bytes = Inputs::of(Target::named(target)?, number(seed)?)?.input(number(input)?);
    std::io::stdout()
        .write_all(&bytes)
        .map_err(|error| error.to_string())?;
    Ok(ExitCode::SUCCESS)
}

/// Tries the content of a file.
fn try_file(target: &str, file: &str) -> Result<ExitCode, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{file}: {error}"))?;
    (Target::named(target)?.start)()(&bytes);
    Ok(ExitCode::SUCCESS)
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("`{text}` is no number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of inputs of each target that every run of the tests tries.
    const TRIED: u64 = 200;

    #[test]
    fn every_target_takes_its_inputs() {
        for target in &Target::ALL {
            let inputs = Inputs::of(target, 0).unwrap();
            let mut take = (target.start)();
            inputs.corpus().for_each(&mut take);
            for number in 0..TRIED {
                take(&inputs.input(number));
            }
        }
    }
}
