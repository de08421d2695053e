//! The sentences of the recording's task, step by step, below the segments.

use bevy_egui::egui::{
    FontId, Rect, Sense, Ui, WidgetInfo, WidgetType, pos2, text::LayoutJob, vec2,
};
use tabletop_core::{ShownStep, SimTick};

use super::{
    axis::TimeAxis,
    model::{Model, Moment},
    track,
};

/// Heights and widths in points.
const HEIGHT: f32 = 20.0;
const NARROWEST: f32 = 6.0;
const EDGE: f32 = 3.0;
const SMALL: FontId = FontId::proportional(10.0);

/// Shows the steps along the time, and returns the moments that the user points out.
pub(super) fn show(ui: &mut Ui, model: &Model, axis: TimeAxis) -> Vec<Moment> {
    let steps = model.shown_steps();
    if steps.is_empty() {
        return Vec::new();
    }
    let size = vec2(ui.available_width(), HEIGHT);
    let (lane, _) = ui.allocate_exact_size(size, Sense::hover());
    let steps = steps.iter().enumerate();
    steps
        .flat_map(|(i, step)| show_step(ui, axis, lane, i + 1, step))
        .collect()
}

fn show_step(
    ui: &mut Ui,
    axis: TimeAxis,
    lane: Rect,
    number: usize,
    step: &ShownStep,
) -> Vec<Moment> {
    let (left, right) = (
        axis.x_of(step.grasp),
        axis.x_of(SimTick(step.release.0 + 1)),
    );
    if !axis.shows(left, right) {
        return Vec::new();
    }
    let right = right.max(left + NARROWEST).min(lane.max.x);
    let left = left.max(lane.min.x).min(right - NARROWEST);
    let rect = Rect::from_x_y_ranges(left..=right, lane.y_range()).shrink2(vec2(0.5, 1.0));
    let response = ui.interact(rect, ui.id().with(("step", number)), Sense::click());
    let sentence = format!("{number}. {}", step.sentence);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &sentence));
    let visuals = ui.style().interact(&response);
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 3.0, visuals.weak_bg_fill);
    if let Some(color) = step.color {
        let edge = Rect::from_min_max(rect.min, pos2(rect.min.x + EDGE, rect.max.y));
        painter.rect_filled(edge, 1.0, track::color(color));
    }
    let ink = visuals.text_color();
    let room = rect.width() - EDGE - 6.0;
    let mut job = LayoutJob::simple_singleline(sentence.clone(), SMALL, ink);
    job.wrap.max_width = room.max(0.0);
    job.wrap.max_rows = 1;
    job.wrap.break_anywhere = true;
    let text = painter.layout_job(job);
    let corner = pos2(
        rect.min.x + EDGE + 3.0,
        rect.center().y - text.size().y / 2.0,
    );
    painter.galley(corner, text, ink);
    let is_chosen = response.clicked();
    response.on_hover_text(sentence);
    is_chosen
        .then_some(Moment::Chosen(step.grasp))
        .into_iter()
        .collect()
}
