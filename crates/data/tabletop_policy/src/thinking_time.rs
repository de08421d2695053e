//! The time that a policy takes to answer, and what the simulation does meanwhile.

use std::time::{Duration, Instant};

use tabletop_core::TICKS_PER_SECOND;

/// What the simulation does while a policy thinks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThinkingTime {
    /// It waits, so that the same answers lead to the same bits, however long they take.
    #[default]
    Waited,
    /// It runs on for so many ticks, and the robot stands still. The same answers lead to the same bits.
    Given(u64),
    /// It runs on for as many ticks as the answer takes, and the robot stands still. Nothing repeats it.
    Measured,
}

impl ThinkingTime {
    /// An answer, and the number of ticks for which the simulation runs on before it is there.
    pub(crate) fn of<T>(self, answer: impl FnOnce() -> T) -> (T, u64) {
        match self {
            Self::Waited => (answer(), 0),
            Self::Given(ticks) => (answer(), ticks),
            Self::Measured => {
                let start = Instant::now();
                let answer = answer();
                (answer, ticks_of(start.elapsed()))
            }
        }
    }
}

/// The number of ticks that have begun after a time.
fn ticks_of(time: Duration) -> u64 {
    let ticks = time.as_nanos() * u128::from(TICKS_PER_SECOND);
    ticks.div_ceil(Duration::from_secs(1).as_nanos()) as u64
}

#[cfg(test)]
mod tests {
    use std::thread::sleep;

    use super::*;

    #[test]
    fn an_answer_takes_as_long_as_is_said_or_measured() {
        assert_eq!(ThinkingTime::Waited.of(|| 5), (5, 0));
        assert_eq!(ThinkingTime::Given(7).of(|| 5), (5, 7));
        let (answer, ticks) = ThinkingTime::Measured.of(|| sleep(Duration::from_millis(50)));
        assert_eq!(answer, ());
        assert!(ticks >= 3, "{ticks}");
    }

    #[test]
    fn a_tick_that_has_begun_counts() {
        let ticks = [0, 1, 100, 1000].map(|ms| ticks_of(Duration::from_millis(ms)));
        assert_eq!(ticks, [0, 1, 6, 60]);
    }
}
