//! Two policies on the same beginnings.

use std::f64::consts::LN_2;

use super::JudgedEpisode;

/// What two policies came to on the same beginnings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairedOutcomes {
    /// Number of beginnings in which both did the task.
    pub both: u64,
    /// In which only the first did.
    pub first: u64,
    /// In which only the second did.
    pub second: u64,
    /// In which neither did.
    pub neither: u64,
}

impl PairedOutcomes {
    /// Those of these pairs.
    pub fn of<'a>(pairs: impl IntoIterator<Item = &'a [&'a JudgedEpisode; 2]>) -> Self {
        Self::counted(
            pairs
                .into_iter()
                .map(|pair| pair.map(|episode| episode.done)),
        )
    }

    fn counted(pairs: impl IntoIterator<Item = [bool; 2]>) -> Self {
        let mut outcomes = Self::default();
        for pair in pairs {
            let count = match pair {
                [true, true] => &mut outcomes.both,
                [true, false] => &mut outcomes.first,
                [false, true] => &mut outcomes.second,
                [false, false] => &mut outcomes.neither,
            };
            *count += 1;
        }
        outcomes
    }

    /// Number of beginnings.
    pub const fn count(self) -> u64 {
        self.both + self.first + self.second + self.neither
    }

    /// The probability of a difference as large as this, or larger, if both policies were equally good: McNemar's test, exact and two-sided.
    pub fn significance(self) -> f64 {
        let differing = self.first + self.second;
        let mut logarithm = -(differing as f64) * LN_2;
        let mut sum = 0.0;
        for number in 0..=self.first.min(self.second) {
            sum += libm::exp(logarithm);
            let way = libm::log((differing - number) as f64) - libm::log((number + 1) as f64);
            logarithm += way;
        }
        (2.0 * sum).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of `scipy.stats.binomtest(first, first + second).pvalue`.
    #[test]
    fn significance_is_that_of_the_exact_test() {
        for (first, second, expected) in [
            (0, 0, 1.0),
            (1, 0, 1.0),
            (6, 0, 0.031_25),
            (0, 6, 0.031_25),
            (10, 2, 0.038_574_218_75),
            (5, 5, 1.0),
            (2000, 2000, 1.0),
        ] {
            let outcomes = PairedOutcomes {
                first,
                second,
                ..PairedOutcomes::default()
            };
            let found = outcomes.significance();
            assert!(
                (found - expected).abs() < 1e-9,
                "{first}, {second}: {found}"
            );
        }
        let far = PairedOutcomes {
            first: 3000,
            ..PairedOutcomes::default()
        };
        assert_eq!(far.significance(), 0.0);
    }

    #[test]
    fn pairs_are_counted() {
        let pairs = [[true, true], [true, false], [true, false], [false, false]];
        let outcomes = PairedOutcomes::counted(pairs);
        let counts = [
            outcomes.both,
            outcomes.first,
            outcomes.second,
            outcomes.neither,
        ];
        assert_eq!((counts, outcomes.count()), ([1, 2, 0, 1], 4));
    }
}
