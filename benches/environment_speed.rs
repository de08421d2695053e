//! Benchmark of an environment: its steps a second on one core, both arms moving over three blocks.
//!
//! `cargo bench --bench environment_speed` prints the median time of a step of 1/20 s, of a picture of 128 x 128, of a reset, and of a copy of
//! the world and the return to it. `-- step` runs only the cases with this in their names, for a profiler.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]
#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::time::{Duration, Instant};

use tabletop::{
    core::Random,
    environment::{EnvironmentOptions, EnvironmentTask, ObservationSpace, TaskEnvironment},
};

const TURNS: usize = 40;

fn main() {
    let named = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    let task = |scatters| {
        let scenario = "shipped:scenarios/stack_three.ron".as_ref();
        EnvironmentTask::of_scenario(scenario, scatters, &[]).unwrap()
    };
    let options = EnvironmentOptions {
        observation: ObservationSpace::Rgb,
        ..EnvironmentOptions::default()
    };
    let make = |scatters| {
        let mut environment = TaskEnvironment::new(task(scatters), &options).unwrap();
        environment.reset(Some(0)).unwrap();
        environment
    };
    let mut random = Random::new(0);
    let mut moving = make(false);
    let mut still = make(false);
    let mut scattered = make(true);
    let mut act = |environment: &mut TaskEnvironment| {
        let action: Vec<_> = (0..environment.action_len())
            .map(|_| random.between((-0.3, 0.3)))
            .collect();
        environment.step(&action).unwrap();
    };
    let mut cases: [(&str, u32, Box<dyn FnMut()>); 5] = [
        ("a step", 20, Box::new(|| act(&mut moving))),
        (
            "a step and a picture",
            20,
            Box::new({
                let mut environment = make(false);
                let mut random = Random::new(0);
                move || {
                    let action: Vec<_> = (0..environment.action_len())
                        .map(|_| random.between((-0.3, 0.3)))
                        .collect();
                    environment.step(&action).unwrap();
                    environment.picture().unwrap();
                }
            }),
        ),
        ("a reset", 4, Box::new(|| still.reset(Some(0)).unwrap())),
        (
            "a reset elsewhere",
            4,
            Box::new(|| scattered.reset(None).unwrap()),
        ),
        (
            "a copy and the return",
            10,
            Box::new({
                let mut environment = make(false);
                move || {
                    let moment = environment.snapshot();
                    environment.restore(&moment).unwrap();
                }
            }),
        ),
    ];
    for (name, times, case) in &mut cases {
        if named.as_ref().is_some_and(|named| !name.contains(named)) {
            continue;
        }
        let mut turns: Vec<Duration> = Vec::new();
        for _ in 0..TURNS {
            let start = Instant::now();
            (0..*times).for_each(|_| case());
            turns.push(start.elapsed() / *times);
        }
        turns.sort();
        let median = turns[TURNS / 2].as_secs_f64();
        println!(
            "{name:24} {:9.1} µs, {:8.0} a second",
            median * 1e6,
            1.0 / median
        );
    }
}
