//! The seeds that a test of random histories tries.

use std::{env, ops::Range};

/// The variable that names other seeds, such as `1000..2000`.
const SEEDS: &str = "SEEDS";

/// The seeds to try: those of a usual run, or those that the variable `SEEDS` names, such as `SEEDS=1000..2000`.
///
/// # Panics
/// The variable is no range.
pub fn seeds(usual: Range<u64>) -> Range<u64> {
    let Ok(named) = env::var(SEEDS) else {
        return usual;
    };
    let range = named.split_once("..").and_then(|(first, end)| {
        let range = first.parse().ok()?..end.parse().ok()?;
        Some(range)
    });
    match range {
        Some(range) => range,
        None => panic!("{SEEDS}={named} is no range of seeds such as 1000..2000"),
    }
}
