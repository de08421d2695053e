//! How often frames come.

use std::{
    thread,
    time::{Duration, Instant},
};

use bevy::{
    prelude::*,
    winit::{UpdateMode, WinitSettings},
};
use tabletop_core::Paused;

use super::redraw::Redraw;

/// Frames a second, unless the user has chosen another number: so many as the simulation has ticks.
const HZ: u32 = 60;

/// How often a window in which nothing happens looks after what comes neither from mouse nor keys, such as a file that has changed.
const IDLE: Duration = Duration::from_millis(250);

/// For how long a paused window goes on as before after the last news.
const LINGER: Duration = Duration::from_millis(500);

/// When the next frame may begin.
#[derive(Resource, Clone, Copy, Debug)]
pub(super) struct Pace {
    period: Duration,
    due: Option<Instant>,
}

impl Default for Pace {
    fn default() -> Self {
        Self::of(HZ)
    }
}

impl Pace {
    /// At most so many frames a second, but at least one.
    pub fn of(hz: u32) -> Self {
        Self {
            period: Duration::from_secs(1) / hz.max(1),
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
    app.init_resource::<Pace>()
        .insert_resource(WinitSettings::continuous())
        .add_systems(Last, rest_while_paused);
}

/// A pause in which nothing happens costs next to nothing; keys and mouse still act at once.
fn rest_while_paused(
    paused: Res<Paused>,
    redraw: Res<Redraw>,
    time: Res<Time<Real>>,
    mut settings: ResMut<WinitSettings>,
) {
    let mode = match paused.0 && redraw.idle_for(time.elapsed()) > LINGER {
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

    #[test]
    fn frames_begin_a_period_apart() {
        let (mut pace, start) = (Pace::of(100), Instant::now());
        assert_eq!(pace.pause(start), Duration::ZERO);
        assert_eq!(pace.pause(start + 3 * MS), 7 * MS);
        assert_eq!(pace.pause(start + 10 * MS), 10 * MS);
    }

    #[test]
    fn a_late_frame_is_made_up_for_and_a_missed_one_is_not() {
        let (mut pace, start) = (Pace::of(100), Instant::now());
        pace.pause(start);
        assert_eq!(pace.pause(start + 14 * MS), Duration::ZERO);
        assert_eq!(pace.pause(start + 15 * MS), 5 * MS);
        assert_eq!(pace.pause(start + 500 * MS), Duration::ZERO);
        assert_eq!(pace.pause(start + 500 * MS), 10 * MS);
    }

    #[test]
    fn a_pause_rests_when_nothing_has_been_new_for_a_while() {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<Paused>()
            .init_resource::<Redraw>()
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
