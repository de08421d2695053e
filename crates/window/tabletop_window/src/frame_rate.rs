//! Frame rate.

use std::{
    num::NonZeroU32,
    thread,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_gui::display::DisplaySettings;

/// The time at which the next frame may begin.
#[derive(Resource, Clone, Copy, Debug)]
pub(super) struct FrameRate {
    period: Duration,
    due: Option<Instant>,
}

impl Default for FrameRate {
    fn default() -> Self {
        Self::of(DisplaySettings::default().refresh_rate)
    }
}

impl FrameRate {
    /// A limit of this many frames a second.
    pub fn of(rate: NonZeroU32) -> Self {
        Self {
            period: Duration::from_secs(1) / rate.get(),
            due: None,
        }
    }

    /// Waits until the next frame may begin.
    pub fn wait(&mut self) {
        let pause = self.pause(Instant::now());
        if !pause.is_zero() {
            thread::sleep(pause);
        }
    }

    /// Time to wait. A delay of less than a period is made up for.
    fn pause(&mut self, now: Instant) -> Duration {
        let due = self
            .due
            .filter(|&due| now <= due + self.period)
            .unwrap_or(now);
        self.due = Some(due + self.period);
        due.saturating_duration_since(now)
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<FrameRate>();
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);
    const HUNDRED: NonZeroU32 = NonZeroU32::new(100).expect("it is not zero");

    #[test]
    fn frames_begin_a_period_apart() {
        let (mut rate, start) = (FrameRate::of(HUNDRED), Instant::now());
        assert_eq!(rate.pause(start), Duration::ZERO);
        assert_eq!(rate.pause(start + 3 * MS), 7 * MS);
        assert_eq!(rate.pause(start + 10 * MS), 10 * MS);
    }

    #[test]
    fn a_late_frame_is_made_up_for_and_a_missed_one_is_not() {
        let (mut rate, start) = (FrameRate::of(HUNDRED), Instant::now());
        rate.pause(start);
        assert_eq!(rate.pause(start + 14 * MS), Duration::ZERO);
        assert_eq!(rate.pause(start + 15 * MS), 5 * MS);
        assert_eq!(rate.pause(start + 500 * MS), Duration::ZERO);
        assert_eq!(rate.pause(start + 500 * MS), 10 * MS);
    }
}
