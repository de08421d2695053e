//! The ends of the selected segments, which are dragged to make the segments faster or slower.

use bevy_egui::egui::{CursorIcon, Rect, Sense, Stroke, Ui, WidgetInfo, WidgetType, pos2, vec2};
use tabletop_core::SimTick;
use tabletop_user::TimelineEdit;

use super::{
    axis::{TimeAxis, seconds},
    model::Model,
    selected_segments::SelectedSegments,
};
use crate::widgets::style::ACCENT;

/// Width of an end that can be dragged, in points.
const WIDTH: f32 = 8.0;

/// Shows the ends in the lane of the segments, and returns the edit of one that was dragged.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    axis: TimeAxis,
    lane: Rect,
    selection: &SelectedSegments,
) -> Option<TimelineEdit> {
    if model.editing.present.is_some() {
        return None;
    }
    let selected = selection.segments().into_iter().flatten();
    selected
        .filter_map(|number| show_end(ui, model, axis, lane, number))
        .last()
}

fn show_end(
    ui: &mut Ui,
    model: &Model,
    axis: TimeAxis,
    lane: Rect,
    number: usize,
) -> Option<TimelineEdit> {
    let start = model.segment(number)?.start;
    let ticks = model.timeline.ticks_of(number);
    if ticks == 0 {
        return None;
    }
    let at = axis.x_of(SimTick(start.0 + ticks));
    if !axis.shows(at, at) {
        return None;
    }
    let rect = Rect::from_center_size(pos2(at, lane.center().y), vec2(WIDTH, lane.height()));
    let response = ui.interact(rect, ui.id().with(("end", number)), Sense::drag());
    let name = format!("End of segment {number}");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Slider, true, &name));
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    let stroke = |width| Stroke::new(width, ACCENT);
    ui.painter().vline(at, lane.y_range(), stroke(3.0));
    let Some(mouse) = response.interact_pointer_pos() else {
        let time = seconds(ticks);
        response.on_hover_text(format!(
            "Drag to let segment {number} take another time than {time}"
        ));
        return None;
    };
    if (mouse.x - at).abs() < WIDTH / 2.0 {
        return None;
    }
    let dragged = axis.ticks_in(mouse.x - axis.x_of(start)).max(1);
    if response.drag_stopped() {
        return Some(TimelineEdit::Retime {
            segment: number,
            ticks: dragged,
        });
    }
    ui.painter().vline(mouse.x, lane.y_range(), stroke(1.0));
    let text = format!("{} instead of {}", seconds(dragged), seconds(ticks));
    response.show_tooltip_text(text);
    None
}
