//! Ranges of seeds.

use std::ops::Range;

/// The most seeds of a command.
const MOST_SEEDS: u64 = 1_000_000;

/// Reads the seeds from one up to but without another.
pub(super) fn seed_range(text: &str) -> Result<Range<u64>, String> {
    let expected = || format!("expected A..B, such as 0..1000, with at most {MOST_SEEDS} seeds");
    let (first, end) = text.split_once("..").ok_or_else(expected)?;
    let read = |text: &str| text.parse::<u64>().map_err(|_| expected());
    let (first, end) = (read(first)?, read(end)?);
    match first < end && end - first <= MOST_SEEDS {
        true => Ok(first..end),
        false => Err(expected()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_a_range_without_its_end() {
        assert_eq!(seed_range("3..5"), Ok(3..5));
        for text in ["5..5", "5..3", "5", "a..b", "0..2000000", "-1..3", ".."] {
            assert!(seed_range(text).is_err(), "{text}");
        }
    }
}
