//! The pace at which a film shows a recording.

use tabletop_core::{SimTick, TICKS_PER_SECOND};

/// The pace at which a film shows a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPace {
    /// Frames of the film a second.
    pub fps: u32,
    /// Simulated seconds a second of the film.
    pub speed: f64,
}

impl FilmPace {
    /// The ticks whose ends the frames show, from a first one to a last one, both included. A slow film shows a tick several times.
    pub fn ticks(&self, first: SimTick, last: SimTick) -> Vec<SimTick> {
        let step = f64::from(TICKS_PER_SECOND) * self.speed / f64::from(self.fps.max(1));
        let between = (0..).map(|frame| first.0 + (f64::from(frame) * step) as u64);
        let mut ticks: Vec<_> = between
            .take_while(|tick| *tick < last.0)
            .map(SimTick)
            .collect();
        ticks.push(last);
        ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(fps: u32, speed: f64, first: u64, last: u64) -> Vec<u64> {
        let ticks = FilmPace { fps, speed }.ticks(SimTick(first), SimTick(last));
        ticks.into_iter().map(|tick| tick.0).collect()
    }

    #[test]
    fn frames_are_evenly_apart_and_the_end_is_shown() {
        assert_eq!(ticks(4, 1.0, 10, 60), [10, 25, 40, 55, 60]);
        assert_eq!(ticks(30, 2.0, 0, 9), [0, 4, 8, 9]);
        assert_eq!(ticks(60, 0.5, 0, 2), [0, 0, 1, 1, 2]);
        assert_eq!(ticks(30, 1.0, 7, 7), [7]);
        assert_eq!(ticks(25, 1.0, 0, 12), [0, 2, 4, 7, 9, 12]);
    }
}
