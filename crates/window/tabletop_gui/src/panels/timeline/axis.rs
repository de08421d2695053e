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
    /// The first and the last tick of the recording.
    whole: [u64; 2],
    /// The first tick that is shown, and the number of those that are.
    start: f64,
    ticks: f64,
}

impl TimeAxis {
    pub fn new(timeline: &Timeline, x: Rangef) -> Self {
        let ticks = timeline.end.0.saturating_sub(timeline.start.0);
        let ticks = ticks.max(SHORTEST);
        Self {
            x,
            whole: [timeline.start.0, timeline.start.0 + ticks],
            start: timeline.start.0 as f64,
            ticks: ticks as f64,
        }
    }

    /// The axis that shows only a part of the time.
    pub fn part(self, start: f64, ticks: f64) -> Self {
        Self {
            start,
            ticks,
            ..self
        }
    }

    /// The place of a tick, which may be beside the part that is shown.
    pub fn x_of(&self, tick: SimTick) -> f32 {
        let [first, last] = self.whole;
        let part = (tick.0.clamp(first, last) as f64 - self.start) / self.ticks;
        self.x.min + part as f32 * self.x.span()
    }

    /// True if something between these places is shown.
    pub fn shows(&self, left: f32, right: f32) -> bool {
        right >= self.x.min && left <= self.x.max
    }

    /// The tick at a place, or the nearest one that is shown.
    pub fn tick_at(&self, x: f32) -> SimTick {
        let part = ((x - self.x.min) / self.x.span()).clamp(0.0, 1.0);
        SimTick((self.start + f64::from(part) * self.ticks).round() as u64)
    }

    /// Number of ticks in a width; none in one to the left.
    pub fn ticks_in(&self, width: f32) -> u64 {
        (f64::from(width / self.x.span()) * self.ticks).round() as u64
    }

    /// The marks of the ruler, each with its text.
    pub fn marks(&self) -> Vec<(f32, String)> {
        let per_second = f64::from(TICKS_PER_SECOND);
        let seconds = self.ticks / per_second;
        let fits =
            |step: &f64| f64::from(self.x.span()) * step / seconds >= f64::from(LEAST_DISTANCE);
        let step = STEPS.into_iter().find(fits).unwrap_or(seconds);
        let before = (self.start - self.whole[0] as f64) / per_second;
        let first = (before / step - 1e-6).ceil() as u64;
        let last = ((before + seconds) / step + 1e-6).floor() as u64;
        let mark = |number| {
            let tick = (number as f64 * step * per_second).round() as u64;
            (
                self.x_of(SimTick(self.whole[0] + tick)),
                seconds_of(tick, step),
            )
        };
        (first..=last).map(mark).collect()
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
