//! The time axis: the places of ticks on the screen.

use bevy_egui::egui::Rangef;
use tabletop_core::{SimTick, TICKS_PER_SECOND, Timeline};

/// The shortest time that is shown, in ticks.
const SHORTEST: u64 = TICKS_PER_SECOND as u64;

/// Distance of the marks on the ruler, in points, at least.
const LEAST_DISTANCE: f32 = 60.0;

/// Times between marks, in seconds.
const STEPS: [f64; 14] = [
    0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 3600.0,
];

/// The time of a recording, from left to right.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeAxis {
    x: Rangef,
    start: u64,
    ticks: u64,
}

impl TimeAxis {
    pub fn new(timeline: &Timeline, x: Rangef) -> Self {
        let ticks = timeline.end.0.saturating_sub(timeline.start.0);
        Self {
            x,
            start: timeline.start.0,
            ticks: ticks.max(SHORTEST),
        }
    }

    pub fn x_of(&self, tick: SimTick) -> f32 {
        let part = tick.0.saturating_sub(self.start) as f32 / self.ticks as f32;
        self.x.min + part.min(1.0) * self.x.span()
    }

    /// The tick at a place, or the nearest one.
    pub fn tick_at(&self, x: f32) -> SimTick {
        let part = ((x - self.x.min) / self.x.span()).clamp(0.0, 1.0);
        SimTick(self.start + (part * self.ticks as f32).round() as u64)
    }

    /// Number of ticks in a width; none in one to the left.
    pub fn ticks_in(&self, width: f32) -> u64 {
        (width / self.x.span() * self.ticks as f32).round() as u64
    }

    /// The marks of the ruler, each with its text.
    pub fn marks(&self) -> Vec<(f32, String)> {
        let per_second = f64::from(TICKS_PER_SECOND);
        let seconds = self.ticks as f64 / per_second;
        let fits =
            |step: &f64| f64::from(self.x.span()) * step / seconds >= f64::from(LEAST_DISTANCE);
        let step = STEPS.into_iter().find(fits).unwrap_or(seconds);
        let count = (seconds / step).floor() as u64;
        let mark = |number| {
            let tick = (number as f64 * step * per_second).round() as u64;
            (
                self.x_of(SimTick(self.start + tick)),
                seconds_of(tick, step),
            )
        };
        (0..=count).map(mark).collect()
    }
}

fn seconds_of(ticks: u64, step: f64) -> String {
    let seconds = ticks as f64 / f64::from(TICKS_PER_SECOND);
    match step < 1.0 {
        true => format!("{seconds:.2} s"),
        false => format!("{seconds:.0} s"),
    }
}

/// A time in seconds.
pub(super) fn seconds(ticks: u64) -> String {
    format!("{:.2} s", ticks as f64 / f64::from(TICKS_PER_SECOND))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(ticks: u64) -> TimeAxis {
        let timeline = Timeline {
            start: SimTick(100),
            end: SimTick(100 + ticks),
            ..Timeline::default()
        };
        TimeAxis::new(&timeline, Rangef::new(10.0, 610.0))
    }

    #[test]
    fn places_and_ticks_belong_together() {
        let axis = axis(600);
        for (tick, x) in [(100, 10.0), (400, 310.0), (700, 610.0)] {
            assert_eq!(axis.x_of(SimTick(tick)), x);
            assert_eq!(axis.tick_at(x), SimTick(tick));
        }
        assert_eq!(axis.tick_at(-50.0), SimTick(100));
        assert_eq!(axis.tick_at(5000.0), SimTick(700));
        assert_eq!(
            [300.0, 900.0, -1.0].map(|x| axis.ticks_in(x)),
            [300, 900, 0]
        );
        assert_eq!(axis.x_of(SimTick(3)), 10.0);
        assert_eq!(axis.x_of(SimTick(9999)), 610.0);
    }

    #[test]
    fn marks_are_round_and_not_crowded() {
        for ticks in [0, 1, 59, 60, 600, 7000, 36_000, 10_000_000] {
            let marks = axis(ticks).marks();
            assert!(!marks.is_empty());
            for pair in marks.windows(2) {
                assert!(pair[1].0 - pair[0].0 >= LEAST_DISTANCE - 1.0, "{marks:?}");
            }
        }
        let texts: Vec<_> = axis(600)
            .marks()
            .into_iter()
            .map(|(_, text)| text)
            .collect();
        assert_eq!(texts[..3], ["0 s", "1 s", "2 s"]);
    }

    #[test]
    fn an_axis_without_time_has_places_nevertheless() {
        let axis = axis(0);
        assert_eq!(axis.x_of(SimTick(100)), 10.0);
        assert_eq!(axis.tick_at(10.0), SimTick(100));
    }
}
