//! The ruler, the segments on it, the grips, and the playhead.

use bevy_egui::egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui,
    WidgetInfo, WidgetType, pos2, vec2,
};
use tabletop_core::{Act, SimTick, TimelineSegment, Verb};
use tabletop_geometry::Rgb;

use super::{
    axis::TimeAxis,
    model::{Model, Moment},
    selected_segments::SelectedSegments,
};
use crate::widgets::style::ACCENT;

/// Heights in points.
const RULER: f32 = 16.0;
const SEGMENTS: f32 = 28.0;
const GRIPS: f32 = 10.0;
pub(super) const HEIGHT: f32 = RULER + SEGMENTS + GRIPS;

/// Side of the square that shows the colour of an object.
const SWATCH: f32 = 10.0;

/// The narrowest segment that can be clicked.
const NARROWEST: f32 = 3.0;

/// Half the width of a mark.
const MARK: f32 = 4.0;

const SMALL: FontId = FontId::proportional(10.0);

pub(super) fn color(color: Rgb) -> Color32 {
    let [red, green, blue] = color.to_bytes();
    Color32::from_rgb(red, green, blue)
}

/// The part of the track in which its segments are.
pub(super) fn lane(track: Rect) -> Rect {
    let top = track.min.y + RULER;
    Rect::from_x_y_ranges(track.x_range(), top..=top + SEGMENTS)
}

/// Shows the track, and returns the moments that the user points out. A click on a segment of an open recording selects it.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    axis: TimeAxis,
    rect: Rect,
    selection: &mut SelectedSegments,
) -> Vec<Moment> {
    let ruler = Rect::from_min_size(rect.min, vec2(rect.width(), RULER));
    let lane = lane(rect);
    let mut moments = show_ruler(ui, model, axis, ruler);
    for number in 0..model.timeline.segments.len() {
        moments.extend(show_segment(ui, model, axis, lane, number, selection));
    }
    show_grips(ui, model, axis, lane.max.y);
    paint_playhead(ui, model, axis, rect);
    moments
}

fn show_ruler(ui: &mut Ui, model: &Model, axis: TimeAxis, rect: Rect) -> Vec<Moment> {
    let response = ui.interact(rect, ui.id().with("ruler"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Slider, true, "Time"));
    let painter = ui.painter_at(rect.expand2(vec2(0.0, SEGMENTS)));
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    for (x, text) in axis.marks() {
        let color = ui.visuals().weak_text_color();
        let (top, bottom) = (rect.max.y - 4.0, rect.max.y);
        painter.vline(x, top..=bottom, Stroke::new(1.0, color));
        let anchor = pos2(x + 2.0, rect.min.y);
        painter.text(anchor, Align2::LEFT_TOP, text, SMALL, color);
    }
    let chosen = moment(&response, axis, model.timeline.start);
    let hover = response.hover_pos().map(|at| axis.tick_at(at.x));
    if let Some(tick) = hover {
        response.on_hover_text_at_pointer(caption_at(model, tick));
    }
    chosen
}

fn show_segment(
    ui: &mut Ui,
    model: &Model,
    axis: TimeAxis,
    lane: Rect,
    number: usize,
    selection: &mut SelectedSegments,
) -> Vec<Moment> {
    let Some(segment) = model.segment(number) else {
        return Vec::new();
    };
    let end = SimTick(model.timeline.end_of(number).0 + 1);
    let (left, right) = (axis.x_of(segment.start), axis.x_of(end));
    if !axis.shows(left, right) {
        return Vec::new();
    }
    let right = right.max(left + NARROWEST).min(lane.max.x);
    let left = left.max(lane.min.x).min(right - NARROWEST);
    let rect = Rect::from_x_y_ranges(left..=right, lane.y_range()).shrink2(vec2(0.5, 1.0));
    let id = ui.id().with(("segment", number));
    let response = ui.interact(rect, id, Sense::click_and_drag());
    let sentence = model.sentence(number);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &sentence));
    let is_present = model.timeline.segment_at(model.playhead()) == Some(number);
    paint_segment(ui, segment, &response, rect, is_present);
    if response.clicked() && model.is_open() {
        selection.choose(model.timeline, number);
    }
    if selection.contains(number) {
        let outline = Stroke::new(1.5, ACCENT);
        ui.painter()
            .rect_stroke(rect, 3.0, outline, StrokeKind::Inside);
    }
    let moments = moment(&response, axis, segment.start);
    if let Some(at) = response.hover_pos() {
        response.on_hover_text_at_pointer(caption_at(model, axis.tick_at(at.x)));
    }
    moments
}

fn paint_segment(
    ui: &Ui,
    segment: &TimelineSegment,
    response: &Response,
    rect: Rect,
    is_present: bool,
) {
    let visuals = ui.style().interact_selectable(response, is_present);
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 3.0, visuals.bg_fill);
    let mut text_left = rect.min.x + 4.0;
    if let Some(object) = segment.color {
        let swatch = vec2(SWATCH.min(rect.width()), SWATCH);
        let corner = pos2(rect.min.x + 3.0, rect.center().y - SWATCH / 2.0);
        painter.rect_filled(Rect::from_min_size(corner, swatch), 2.0, color(object));
        text_left += SWATCH + 3.0;
    }
    let ink = visuals.text_color();
    let room = rect.max.x - text_left;
    let texts = texts(segment.act.as_ref()).map(|text| painter.layout_no_wrap(text, SMALL, ink));
    let [.., shortest] = &texts;
    let fitting = texts.iter().find(|text| text.size().x <= room);
    let text = fitting.unwrap_or(shortest);
    let top_left = pos2(text_left, rect.center().y - text.size().y / 2.0);
    painter.galley(top_left, text.clone(), ink);
}

/// The texts of a segment, the longest one first.
fn texts(act: Option<&Act>) -> [String; 3] {
    let Some(act) = act else {
        return ["Beginning", "Begin", ""].map(str::to_owned);
    };
    let object = act.object.as_deref().unwrap_or_default();
    [
        act.to_string(),
        format!("{} {object}", act.verb.name()),
        object.to_owned(),
    ]
}

/// Grips are marked upwards, releases downwards.
fn show_grips(ui: &mut Ui, model: &Model, axis: TimeAxis, top: f32) {
    for (number, grip) in model.timeline.grips.iter().enumerate() {
        let x = axis.x_of(grip.tick);
        if !axis.shows(x, x) {
            continue;
        }
        let center = pos2(x, top + GRIPS / 2.0);
        let rect = Rect::from_center_size(center, vec2(8.0, GRIPS));
        let response = ui.interact(rect, ui.id().with(("grip", number)), Sense::hover());
        let sentence = format!("{}: {}", model.time(grip.tick), grip.act);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &sentence));
        let up = match grip.act.verb {
            Verb::Grasp | Verb::Trigger | Verb::PointTo | Verb::Fasten => MARK,
            Verb::Release | Verb::Destroy | Verb::Loosen | Verb::Cut => -MARK,
        };
        let ink = ui.visuals().strong_text_color();
        paint_mark(ui.painter(), center, up, ink);
        response.on_hover_text(sentence);
    }
}

fn paint_playhead(ui: &Ui, model: &Model, axis: TimeAxis, rect: Rect) {
    let painter = ui.painter_at(rect.expand2(vec2(MARK, 0.0)));
    if let Some(goal) = model.playback.goal {
        let ink = ui.visuals().weak_text_color();
        painter.vline(axis.x_of(goal), rect.y_range(), Stroke::new(1.0, ink));
    }
    let x = axis.x_of(model.playhead());
    let ink = ui.visuals().strong_text_color();
    painter.vline(x, rect.y_range(), Stroke::new(1.5, ink));
    paint_mark(&painter, pos2(x, rect.min.y + MARK), -MARK, ink);
}

/// A triangle that points so far up.
fn paint_mark(painter: &Painter, center: Pos2, up: f32, color: Color32) {
    let corners = [(-MARK, up), (MARK, up), (0.0, -up)];
    let corners = corners.map(|(x, y)| center + vec2(x, y));
    let shape = Shape::convex_polygon(corners.into(), color, Stroke::NONE);
    painter.add(shape);
}

/// The moment under the mouse while it drags, or the one that is chosen: by a key or another program, the first one.
pub(super) fn moment(response: &Response, axis: TimeAxis, first: SimTick) -> Vec<Moment> {
    let under_mouse = response
        .interact_pointer_pos()
        .map(|place| axis.tick_at(place.x));
    if response.clicked() || response.drag_stopped() {
        vec![Moment::Chosen(under_mouse.unwrap_or(first))]
    } else if response.dragged() {
        under_mouse.map(Moment::Dragged).into_iter().collect()
    } else {
        Vec::new()
    }
}

/// The time of a moment, and the sentence of its segment.
pub(super) fn caption_at(model: &Model, tick: SimTick) -> String {
    let time = model.time(tick);
    match model.timeline.segment_at(tick) {
        Some(number) => format!("{time}\n{}", model.sentence(number)),
        None => time,
    }
}
