//! `tabletop soak`: hours of random acts of a user, with checks of the world.

use std::{fs, path::Path, process::ExitCode, time::Instant};

use crate::{core::TICKS_PER_SECOND, run_episodes, soak::Round, storage::TemporaryFolder};
use clap::Args;

use super::{
    Failure,
    range::{NumberRange, SEEDS},
    terminal::{say, show_warnings},
};

/// Largest growth of memory, in bytes, from the first half of the rounds to the last quarter.
const MOST_GROWTH: u64 = 64 << 20;

const HOURS: NumberRange<f64> = NumberRange::decimal(0.0, 10_000.0).of("hours");

#[derive(Args)]
pub(super) struct SoakArgs {
    /// The seed of the random acts, from 0 to 18446744073709551615
    #[arg(long, value_name = "N", default_value = "0", value_parser = SEEDS, allow_negative_numbers = true)]
    seed: u64,
    /// Number of hours to simulate, from 0 to 10000, not counting replays
    #[arg(long, value_name = "H", default_value = "1", value_parser = HOURS, allow_negative_numbers = true)]
    hours: f64,
}

pub(super) fn soak(args: &SoakArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let round_hours = Round::TICKS as f64 / f64::from(TICKS_PER_SECOND) / 3600.0;
    let rounds = (args.hours / round_hours).ceil().max(1.0) as u64;
    let mut said = Instant::now();
    let mut memory = Vec::new();
    let run = |number| {
        let temporary = TemporaryFolder::new("tabletop-soak").map_err(Failure::run)?;
        let round = Round {
            seed: args.seed.wrapping_add(number),
            folder: temporary.path().to_owned(),
        };
        round.run().map_err(|fault| {
            let seed = round.seed;
            Failure::run(format!(
                "{fault}; to see it: tabletop soak --seed {seed} --hours 0"
            ))
        })
    };
    run_episodes(0..rounds, 1, run, |number, ()| {
        memory.push(memory_now());
        if said.elapsed().as_secs() >= 60 || number + 1 == rounds {
            said = Instant::now();
            say(format_args!(
                "tabletop: {:.2} of {:.2} h simulated, {} recordings replayed, {} MB",
                (number + 1) as f64 * round_hours,
                rounds as f64 * round_hours,
                number + 1,
                memory_now() >> 20,
            ));
        }
        Ok(())
    })?;
    match growth(&memory) {
        growth if growth > MOST_GROWTH => Err(Failure::run(format!(
            "memory has grown by {} MB; to see it, repeat the command",
            growth >> 20
        ))),
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// The difference between the largest value of the last quarter and that of the first half, in which all memory is filled once.
fn growth(memory: &[u64]) -> u64 {
    let (half, quarter) = (memory.len() / 2, memory.len() / 4);
    let largest = |part: &[u64]| part.iter().copied().max().unwrap_or_default();
    let first = largest(memory.get(..half).unwrap_or_default());
    let last = largest(memory.get(memory.len() - quarter..).unwrap_or_default());
    last.saturating_sub(first)
}

/// The memory of this process in bytes, where it can be measured.
fn memory_now() -> u64 {
    let text = fs::read_to_string(Path::new("/proc/self/statm")).unwrap_or_default();
    let pages = text.split(' ').nth(1).and_then(|pages| pages.parse().ok());
    pages.unwrap_or(0_u64) * 4096
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_compares_the_end_with_the_beginning() {
        assert_eq!(growth(&[1, 9, 5, 5, 5, 5, 9, 8]), 0);
        assert_eq!(growth(&[1, 2, 3, 4, 5, 6, 7, 8]), 4);
        assert_eq!(growth(&[]), 0);
        assert_eq!(growth(&[5]), 0);
    }
}
