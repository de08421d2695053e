//! Writers and readers of the same places, of whose calls to the file system some fail, in an order that a seed draws.
//!
//! Afterwards, everything that was promised is there, and everything that was there before; what is not whole has no name; a repair ends in
//! a usable set; and whoever failed has said where. A seed that finds otherwise prints the shortest history that does.
//!
//! `SEEDS=0..100000 cargo test --release -p tabletop -p tabletop_dataset --test storage_faults -- --nocapture` tries others.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod history;
mod operation;
mod promise;
mod stage;
mod workplace;

use std::{
    ops::Range,
    sync::atomic::{AtomicU64, Ordering},
    thread,
};

use history::History;
use operation::Operation;
use tabletop_harness::seeds;

/// The seeds of a usual run.
const SEEDS: Range<u64> = 0..10_000;

#[test]
fn nothing_is_lost_or_made_up_whatever_fails() {
    let seeds = seeds(SEEDS);
    let next = AtomicU64::new(seeds.start);
    let search = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end {
                return None;
            }
            let history = History::drawn(seed, &Operation::ALL);
            if history.perform(seed).is_err() {
                return Some((seed, history.shortest(seed)));
            }
        }
    };
    let found = thread::scope(|scope| {
        let searches = [(), ()].map(|()| scope.spawn(search));
        searches.map(|search| search.join().unwrap())
    });
    let found: Vec<_> = found.into_iter().flatten().collect();
    let told: Vec<_> = found
        .iter()
        .map(|(seed, history)| {
            let fault = history.perform(*seed).unwrap_err();
            format!("seed {seed}: {history}: {fault}\n")
        })
        .collect();
    assert!(told.is_empty(), "{}", told.concat());
}

#[test]
fn a_careless_writer_is_found() {
    let is_found = |seed| {
        let history = History::drawn(seed, &[Operation::Careless]);
        history.perform(seed).is_err()
    };
    assert!((0..300).any(is_found));
}
