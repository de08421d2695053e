//! Benchmark of many environments in one process: their steps a second on all cores, and the memory that each takes.
//!
//! `cargo bench --bench many_worlds` prints this for 1 to 1,024 worlds with both arms moving over three blocks, with and without
//! pictures of 128 x 128. `-- 256` measures only so many.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    fs,
    time::{Duration, Instant},
};

use tabletop::{
    core::Random,
    environment::{
        Autoreset, EnvironmentOptions, EnvironmentTask, ObservationSpace, VectorEnvironment,
    },
};

const COUNTS: [usize; 4] = [1, 16, 256, 1024];
const TIME: Duration = Duration::from_secs(4);

fn main() {
    let named = std::env::args().skip(1).find_map(|arg| arg.parse().ok());
    let counts = named.map_or(COUNTS.to_vec(), |count| vec![count]);
    // What all worlds share is there before the first is counted.
    drop(worlds(1, ObservationSpace::Rgb));
    println!("worlds  with pictures  MB a world   without  MB a world   steps a second");
    for count in counts {
        let [pictures, states] = [ObservationSpace::Rgb, ObservationSpace::State].map(|observed| {
            let before = resident_bytes();
            let mut many = worlds(count, observed);
            let rate = steps_a_second(&mut many);
            let grown = resident_bytes().saturating_sub(before) as f64 / count as f64;
            (rate, grown / 1e6)
        });
        println!(
            "{count:6}  {:13.0}  {:10.2}  {:8.0}  {:10.2}",
            pictures.0, pictures.1, states.0, states.1
        );
    }
}

fn worlds(count: usize, observation: ObservationSpace) -> VectorEnvironment {
    let scenario = "shipped:scenarios/stack_three.ron".as_ref();
    let task = EnvironmentTask::of_scenario(scenario, false, &[]).unwrap();
    let options = EnvironmentOptions {
        observation,
        ..EnvironmentOptions::default()
    };
    let mut many = VectorEnvironment::new(&task, &options, count, 0, Autoreset::NextStep).unwrap();
    let seeds: Vec<_> = (0..count as u64).map(Some).collect();
    many.reset(&seeds, || true).unwrap();
    many
}

fn steps_a_second(many: &mut VectorEnvironment) -> f64 {
    let mut random = Random::new(0);
    let mut step = || {
        let numbers = many.len() * many.action_len();
        let actions: Vec<_> = (0..numbers).map(|_| random.between((-0.3, 0.3))).collect();
        many.step(&actions, || true).unwrap();
        many.len()
    };
    step();
    let (start, mut steps) = (Instant::now(), 0);
    while start.elapsed() < TIME {
        steps += step();
    }
    steps as f64 / start.elapsed().as_secs_f64()
}

/// The bytes of this process in memory, whose pages have 4 KiB; 0 where the system does not say.
fn resident_bytes() -> u64 {
    let pages = fs::read_to_string("/proc/self/statm").ok();
    let pages = pages.and_then(|text| text.split(' ').nth(1)?.parse::<u64>().ok());
    pages.unwrap_or_default() * 4096
}
