//! The number of things that a command does at a time.

use std::thread;

use super::range::NumberRange;

/// The numbers that `--jobs` takes.
pub(super) const JOBS: NumberRange<usize> = NumberRange::whole(1, 256);

/// The number that was asked for, or that of the cores, but no more than there is work.
pub(super) fn at_a_time(jobs: Option<usize>, work: usize) -> usize {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    jobs.unwrap_or_else(cores).clamp(1, work.max(1))
}
