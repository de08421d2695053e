//! Runs of numbers on the command line, such as `5-6`.

use std::ops::RangeInclusive;

/// Reads a number or a run of numbers, such as `5-6`.
pub(super) fn run_of(text: &str) -> Result<RangeInclusive<u32>, String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let number = |text: &str| text.parse::<u32>().ok();
    let ends = number(first).zip(number(last));
    ends.filter(|(first, last)| first <= last && last - first < MOST_NUMBERS)
        .map(|(first, last)| first..=last)
        .ok_or_else(|| "expected a number or a run, such as 3 or 5-6".into())
}

/// Numbers in a run, at most.
const MOST_NUMBERS: u32 = 1_000_000;
