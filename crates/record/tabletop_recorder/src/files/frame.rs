//! Frames: the moments at which a recording looks at the objects.

use tabletop_core::{SimTick, TICKS_PER_SECOND};

/// Frames per second of simulated time.
pub const FRAMES_PER_SECOND: u32 = 4;

/// Ticks from one frame to the next.
pub const TICKS_PER_FRAME: u64 = (TICKS_PER_SECOND / FRAMES_PER_SECOND) as u64;

/// The clock of a recording: frame `f` is the end of the `f * TICKS_PER_FRAME`-th tick after the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrameClock {
    /// The first recorded tick.
    pub(crate) start: SimTick,
}

impl FrameClock {
    /// The frame of this tick: the first one that is not before it.
    pub(crate) fn frame(self, tick: SimTick) -> u64 {
        self.elapsed(tick).div_ceil(TICKS_PER_FRAME)
    }

    /// True if a frame is taken at the end of this tick.
    pub(crate) fn is_frame(self, tick: SimTick) -> bool {
        self.elapsed(tick).is_multiple_of(TICKS_PER_FRAME)
    }

    /// The tick at whose end a frame is taken.
    pub(crate) fn tick(self, frame: u64) -> SimTick {
        SimTick(
            self.start
                .0
                .saturating_add(frame.saturating_mul(TICKS_PER_FRAME)),
        )
    }

    fn elapsed(self, tick: SimTick) -> u64 {
        tick.0.saturating_sub(self.start.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fifteenth_tick_is_a_frame_for_ten_minutes() {
        let start = 7;
        let clock = FrameClock {
            start: SimTick(start),
        };
        let ticks = (start..).map(SimTick).take(10 * 60 * 60 + 1);
        let frames: Vec<_> = ticks.filter(|&tick| clock.is_frame(tick)).collect();
        assert_eq!(frames.len(), 10 * 60 * 4 + 1);
        for (number, tick) in frames.into_iter().enumerate() {
            assert_eq!(tick.0, start + 15 * number as u64);
            assert_eq!(clock.frame(tick), number as u64);
            assert_eq!(clock.tick(number as u64), tick);
        }
    }

    #[test]
    fn ticks_between_two_frames_belong_to_the_later() {
        let clock = FrameClock {
            start: SimTick(100),
        };
        let frames = [100, 101, 114, 115, 116].map(|tick| clock.frame(SimTick(tick)));
        assert_eq!(frames, [0, 1, 1, 1, 2]);
    }
}
