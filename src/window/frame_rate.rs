//! How often frames come.

use std::{
    num::NonZeroU32,
    thread,
    time::{Duration, Instant},
};

use bevy::{
    prelude::*,
    winit::{UpdateMode, WinitSettings},
};
use tabletop_core::Paused;
use tabletop_gui::display::DisplaySettings;

use super::{opening::Opening, redraw::Redraw};

/// How often a window in which nothing happens looks after what comes neither from mouse nor keys, such as a file that has changed.
const IDLE: Duration = Duration::from_millis(250);

/// For how long a paused window goes on as before after the last news.
const LINGER: Duration = Duration::from_millis(500);

/// When the next frame may begin.
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
    /// At most so many frames a second.
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

    /// For how long to wait. A frame that is late by less than a period is made up for.
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
    app.init_resource::<FrameRate>()
        .insert_resource(WinitSettings::continuous())
        .add_systems(Last, rest_while_waiting);
}

/// A window that waits for the user costs next to nothing; keys and mouse still act at once.
fn rest_while_waiting(
    paused: Res<Paused>,
    opening: Res<Opening>,
    redraw: Res<Redraw>,
    time: Res<Time<Real>>,
    mut settings: ResMut<WinitSettings>,
) {
    let is_waiting = paused.0 || *opening != Opening::Done;
    let mode = match is_waiting && redraw.idle_for(time.elapsed()) > LINGER {
        true => UpdateMode::reactive_low_power(IDLE),
        false => UpdateMode::Continuous,
    };
    if settings.focused_mode != mode {
        *settings = WinitSettings {
            focused_mode: mode,
            unfocused_mode: mode,
        };
    }
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

    #[test]
    fn a_pause_rests_when_nothing_has_been_new_for_a_while() {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<Paused>()
            .init_resource::<Redraw>()
            .insert_resource(Opening::Done)
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(100 * MS))
            .add_plugins(plugin);
        let mut modes = |paused| {
            app.insert_resource(Paused(paused));
            for _ in 0..10 {
                app.update();
            }
            app.world().resource::<WinitSettings>().focused_mode
        };
        assert_eq!(modes(false), UpdateMode::Continuous);
        assert_eq!(modes(true), UpdateMode::reactive_low_power(IDLE));
        assert_eq!(modes(false), UpdateMode::Continuous);
    }
}
