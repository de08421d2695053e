//! Benchmark of many environments in one process: their steps a second on all cores, and the memory that each takes.
//!
//! `cargo bench --bench many_worlds` prints this for 1 to 1,024 worlds with both arms moving over three blocks, with pictures of
//! 128 x 128 and without. `-- 256 rgb` and `-- 256 state` measure only this.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    env, fs,
    process::Command,
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
    let arguments: Vec<_> = env::args().skip(1).filter(|it| it != "--bench").collect();
    let [count, observed] = &arguments[..] else {
        println!("worlds  observed  steps a second  MB a world after the first");
        for count in COUNTS {
            for observed in [ObservationSpace::Rgb, ObservationSpace::State] {
                // In a process of its own, so that no memory is left of others.
                let mut process = Command::new(env::current_exe().unwrap());
                let arguments = [&count.to_string(), observed.name()];
                process.args(arguments).status().unwrap();
            }
        }
        return;
    };
    let count = count.parse().unwrap();
    let is_it = |it: &ObservationSpace| it.name() == observed;
    let space = ObservationSpace::ALL.into_iter().find(is_it).unwrap();
    let mut first = worlds(1, space);
    steps_a_second(&mut first, Duration::ZERO);
    let before = resident_bytes();
    let mut many = worlds(count, space);
    let rate = steps_a_second(&mut many, TIME);
    let grown = resident_bytes().saturating_sub(before) as f64 / count as f64;
    println!("{count:6}  {observed:8}  {rate:14.0}  {:26.2}", grown / 1e6);
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

fn steps_a_second(many: &mut VectorEnvironment, time: Duration) -> f64 {
    let mut random = Random::new(0);
    let mut step = || {
        let numbers = many.len() * many.action_len();
        let actions: Vec<_> = (0..numbers).map(|_| random.between((-0.3, 0.3))).collect();
        many.step(&actions, || true).unwrap();
        many.len()
    };
    step();
    let (start, mut steps) = (Instant::now(), 0);
    while start.elapsed() < time {
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
