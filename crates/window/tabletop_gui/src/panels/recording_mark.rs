//! The red mark over everything while a recording runs, with its segment and time.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Align2, Area, Color32, Context, Frame, Id, Order, RichText, Sense, Vec2, vec2},
};
use tabletop_core::{Recording, SimTick, TICKS_PER_SECOND, Timeline};

use crate::files::short_name;

/// Distance from the upper edge of the window, and radius of the mark, in points.
const BELOW: f32 = 6.0;
const RADIUS: f32 = 5.0;

const RED: Color32 = Color32::from_rgb(235, 40, 40);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_mark);
}

fn show_mark(
    mut contexts: EguiContexts,
    recording: Res<Recording>,
    timeline: Res<Timeline>,
    tick: Res<SimTick>,
) {
    if let Ok(context) = contexts.ctx_mut()
        && recording.0
    {
        show(context, &text(&timeline, *tick));
    }
}

/// The name, segment and time of a recording. Whole seconds, so that the window can rest while nothing moves.
fn text(timeline: &Timeline, tick: SimTick) -> String {
    let name = short_name(&timeline.folder);
    let segment = timeline.segments.len().saturating_sub(1);
    let seconds = tick.0.saturating_sub(timeline.start.0) / u64::from(TICKS_PER_SECOND);
    format!(
        "{name}   segment {segment}   {}:{:02}",
        seconds / 60,
        seconds % 60
    )
}

fn show(context: &Context, text: &str) {
    Area::new(Id::new("recording mark"))
        .order(Order::Foreground)
        .anchor(Align2::CENTER_TOP, vec2(0.0, BELOW))
        .interactable(false)
        .fade_in(false)
        .show(context, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.horizontal(|ui| {
                    let size = Vec2::splat(2.0 * RADIUS);
                    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
                    ui.painter().circle_filled(rect.center(), RADIUS, RED);
                    ui.label(RichText::new(text).strong());
                })
            })
        });
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::TimelineSegment;

    use super::*;

    #[test]
    fn it_names_take_segment_and_time() {
        let begun = |tick| TimelineSegment {
            start: SimTick(tick),
            act: None,
            color: None,
        };
        let timeline = Timeline {
            folder: "mine/tower-03".into(),
            start: SimTick(60),
            segments: vec![begun(60), begun(90)],
            ..default()
        };
        let text = text(&timeline, SimTick(60 + 60 * 75 + 30));
        assert_eq!(text, "tower-03   segment 1   1:15");
        let harness = Harness::new_ui(|ui| show(ui.ctx(), &text));
        assert!(harness.query_by_label(&text).is_some());
    }
}
