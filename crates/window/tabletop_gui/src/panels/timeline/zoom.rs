//! The part of a recording's time that is shown.

use bevy_egui::egui::{Rangef, Rect, Ui};
use tabletop_core::{SimTick, TICKS_PER_SECOND, Timeline};

use super::{axis::TimeAxis, model::Model};
use crate::widgets::button::button;

/// The shortest time that is shown, in ticks: half a second.
const SHORTEST: f64 = TICKS_PER_SECOND as f64 / 2.0;

/// The part of the shown time that a click on a button leaves.
const STEP: f64 = 0.5;

/// Points of the wheel after which a tenth of the time is left.
const WHEEL: f32 = 500.0;

/// The part of the time before the playhead, when the view follows it.
const BEFORE: f64 = 0.1;

/// The part of the time that is shown; all of it at first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Zoom {
    /// Its first tick and its length in ticks.
    part: Option<(f64, f64)>,
}

impl Zoom {
    /// The axis that shows this part.
    pub fn axis(&self, timeline: &Timeline, x: Rangef) -> TimeAxis {
        let whole = TimeAxis::new(timeline, x);
        match self.part {
            None => whole,
            Some((start, ticks)) => whole.part(start, ticks),
        }
    }

    /// Shows a part of the time around a tick that stays in its place.
    fn zoom(&mut self, timeline: &Timeline, around: SimTick, factor: f64) {
        let (first, all) = whole(timeline);
        let (start, ticks) = self.part.unwrap_or((first, all));
        let around = around.0 as f64;
        let shown = (ticks * factor).max(SHORTEST.min(all));
        let before = (around - start) / ticks * shown;
        self.part = (shown < all).then_some((around - before, shown));
        self.keep_within(timeline);
    }

    fn pan(&mut self, timeline: &Timeline, ticks: f64) {
        if let Some((start, _)) = &mut self.part {
            *start += ticks;
        }
        self.keep_within(timeline);
    }

    fn keep_within(&mut self, timeline: &Timeline) {
        let (first, all) = whole(timeline);
        if let Some((start, ticks)) = &mut self.part {
            *start = start.clamp(first, (first + all - *ticks).max(first));
        }
    }

    /// Goes along with a playhead that leaves the shown part.
    pub fn follow(&mut self, timeline: &Timeline, playhead: SimTick) {
        let at = playhead.0 as f64;
        if let Some((start, ticks)) = &mut self.part
            && !(*start..=*start + *ticks).contains(&at)
        {
            *start = at - BEFORE * *ticks;
            self.keep_within(timeline);
        }
    }

    /// The wheel over the track: up to see less of the time, sideways or with Shift to see another part.
    pub fn turn_wheel(&mut self, ui: &Ui, timeline: &Timeline, axis: TimeAxis, track: Rect) {
        if !ui.rect_contains_pointer(track) {
            return;
        }
        let (pointer, turned) = ui.input_mut(|input| {
            let turned = std::mem::take(&mut input.smooth_scroll_delta);
            (input.pointer.hover_pos(), turned)
        });
        let Some(pointer) = pointer else { return };
        if turned.x != 0.0 {
            let ticks = axis.ticks_in(turned.x.abs()) as f64;
            self.pan(timeline, -ticks.copysign(f64::from(turned.x)));
        }
        if turned.y != 0.0 {
            let factor = 10_f64.powf(-f64::from(turned.y / WHEEL));
            self.zoom(timeline, axis.tick_at(pointer.x), factor);
        }
    }

    /// The buttons that show more or less of the time, around the playhead.
    pub fn buttons(&mut self, ui: &mut Ui, model: &Model) {
        let timeline = model.timeline;
        let less = "Shows less of the time, around the playhead; also the wheel over the track";
        if button(ui, true, "Zoom in", less).clicked() {
            self.zoom(timeline, model.playhead(), STEP);
        }
        let is_part = self.part.is_some();
        if button(ui, is_part, "Zoom out", "Shows more of the time").clicked() {
            self.zoom(timeline, model.playhead(), 1.0 / STEP);
        }
        if button(ui, is_part, "Whole time", "Shows the whole recording").clicked() {
            self.part = None;
        }
    }
}

/// The first tick of a recording, and its length in ticks.
fn whole(timeline: &Timeline) -> (f64, f64) {
    let ticks = timeline.end.0.saturating_sub(timeline.start.0);
    (timeline.start.0 as f64, ticks as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline() -> Timeline {
        Timeline {
            start: SimTick(100),
            end: SimTick(6100),
            ..Timeline::default()
        }
    }

    fn shown(zoom: &Zoom) -> [SimTick; 2] {
        let axis = zoom.axis(&timeline(), Rangef::new(0.0, 600.0));
        [axis.tick_at(0.0), axis.tick_at(600.0)]
    }

    #[test]
    fn what_is_zoomed_at_stays_in_its_place() {
        let mut zoom = Zoom::default();
        assert_eq!(shown(&zoom), [100, 6100].map(SimTick));
        zoom.zoom(&timeline(), SimTick(3100), 0.5);
        assert_eq!(shown(&zoom), [1600, 4600].map(SimTick));
        zoom.zoom(&timeline(), SimTick(1600), 0.5);
        assert_eq!(shown(&zoom), [1600, 3100].map(SimTick));
        zoom.pan(&timeline(), 9999.0);
        assert_eq!(shown(&zoom), [4600, 6100].map(SimTick));
        zoom.follow(&timeline(), SimTick(1000));
        assert_eq!(shown(&zoom), [850, 2350].map(SimTick));
        zoom.zoom(&timeline(), SimTick(1000), 1e-9);
        let [from, to] = shown(&zoom);
        assert_eq!(to.0 - from.0, 30);
        zoom.zoom(&timeline(), SimTick(1000), 1e9);
        assert_eq!(zoom, Zoom::default());
    }
}
