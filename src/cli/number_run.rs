//! Runs of numbers on the command line, such as `5-6`.

use std::ops::RangeInclusive;

use super::range::NumberRange;

const NUMBERS: NumberRange<u32> = NumberRange::whole(0, u32::MAX);

/// Reads a number or a run of numbers, such as `5-6`.
pub(super) fn run_of(text: &str) -> Result<RangeInclusive<u32>, String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let (first, last) = (NUMBERS.read(first)?, NUMBERS.read(last)?);
    match first <= last && last - first < MOST_NUMBERS {
        true => Ok(first..=last),
        false => Err(format!("{text} is no run of numbers, such as 5-6")),
    }
}

/// Numbers in a run, at most.
const MOST_NUMBERS: u32 = 1_000_000;
