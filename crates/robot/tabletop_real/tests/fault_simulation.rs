//! A simulation of faults: pilot, guard and a mock Baxter in one process, under a virtual clock. A seed draws what the program orders, what goes wrong and
//! when; whatever it is, the same invariants hold. `SEEDS=0..10000` names the seeds.
#![expect(clippy::unwrap_used, reason = "a test may panic")]
#![expect(clippy::print_stdout, reason = "it tells how the trials ended")]

#[path = "fault_simulation/history.rs"]
mod history;
#[path = "fault_simulation/robot.rs"]
mod robot;
#[path = "fault_simulation/trial.rs"]
mod trial;

use std::{
    collections::BTreeMap,
    ops::Range,
    sync::{
        Mutex,
        atomic::{AtomicU64, Ordering},
    },
    thread,
};

use history::History;
use tabletop_harness::seeds;
use trial::{Trial, Violation};

/// The seeds of every run.
const SEEDS: Range<u64> = 0..2_000;

/// The shortest history that still violates an invariant.
fn shortest(trial: &Trial, mut history: History) -> (History, Violation) {
    let mut violation = trial.run(&history).unwrap_err();
    let mut place = 0;
    while place < history.events.len() {
        let mut shorter = history.clone();
        shorter.events.remove(place);
        match trial.run(&shorter) {
            Err(other) => (history, violation) = (shorter, other),
            Ok(_) => place += 1,
        }
    }
    (history, violation)
}

#[test]
fn whatever_goes_wrong_the_invariants_hold() {
    let seeds = seeds(SEEDS);
    let next = AtomicU64::new(seeds.start);
    let ends: Mutex<BTreeMap<String, usize>> = Mutex::default();
    let found = Mutex::new(None);
    let threads = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let trial = Trial::new();
                while found.lock().unwrap().is_none() {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= seeds.end {
                        return;
                    }
                    let history = History::draw(seed);
                    match trial.run(&history) {
                        Ok(end) => *ends.lock().unwrap().entry(end).or_default() += 1,
                        Err(_) => {
                            let shortest = shortest(&trial, history);
                            found.lock().unwrap().get_or_insert((seed, shortest));
                        }
                    }
                }
            });
        }
    });
    for (end, count) in ends.into_inner().unwrap() {
        println!("{count:6} {end}");
    }
    if let Some((seed, (history, violation))) = found.into_inner().unwrap() {
        panic!("seed {seed}: {violation}\n{history}");
    }
}
