//! The pictures of a recording: a strip of small ones, and a large one.

use bevy_egui::egui::{
    Area, Color32, Frame, Id, Order, Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, WidgetType, pos2,
    vec2,
};
use tabletop_core::{SimTick, TimelinePicture};

use super::{
    axis::TimeAxis,
    model::{Model, Moment},
    track,
};
use crate::pictures::Pictures;

/// Sizes in points.
const SMALL: Vec2 = vec2(80.0, 60.0);
const LARGE: Vec2 = vec2(320.0, 240.0);
const GAP: f32 = 4.0;

/// The colour in place of a picture that is not there.
const MISSING: Color32 = Color32::from_gray(30);

/// Shows small pictures, each below its time, and returns the moments that the user points out.
pub(super) fn show(
    ui: &mut Ui,
    model: &Model,
    axis: TimeAxis,
    pictures: &mut Pictures,
) -> Vec<Moment> {
    let size = vec2(ui.available_width(), SMALL.y);
    let (strip, _) = ui.allocate_exact_size(size, Sense::hover());
    let count = ((strip.width() + GAP) / (SMALL.x + GAP)).floor().max(1.0);
    let step = (strip.width() - SMALL.x) / (count - 1.0).max(1.0);
    let mut moments = Vec::new();
    let mut last = None;
    for slot in 0..count as usize {
        let corner = pos2(strip.min.x + slot as f32 * step, strip.min.y);
        let rect = Rect::from_min_size(corner, SMALL);
        let picture = model.timeline.picture_at(axis.tick_at(rect.center().x));
        let Some(picture) = picture.filter(|picture| last != Some(picture.tick)) else {
            continue;
        };
        last = Some(picture.tick);
        moments.extend(show_small(ui, model, rect, picture, pictures));
    }
    moments
}

fn show_small(
    ui: &mut Ui,
    model: &Model,
    rect: Rect,
    picture: &TimelinePicture,
    pictures: &mut Pictures,
) -> Option<Moment> {
    let id = ui.id().with(("picture", picture.tick.0));
    let response = ui.interact(rect, id, Sense::click());
    let name = format!("Picture of {}", model.time(picture.tick));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
    paint(ui, rect, Some(picture), pictures);
    if response.hovered() {
        let stroke = ui.visuals().widgets.hovered.fg_stroke;
        let kind = bevy_egui::egui::StrokeKind::Inside;
        ui.painter().rect_stroke(rect, 0.0, stroke, kind);
    }
    let response = response.on_hover_text(track::caption_at(model, picture.tick));
    response.clicked().then_some(Moment::Chosen(picture.tick))
}

/// Shows the picture of a moment, large.
pub(super) fn show_large(ui: &mut Ui, model: &Model, tick: SimTick, pictures: &mut Pictures) {
    let (rect, response) = ui.allocate_exact_size(LARGE, Sense::hover());
    let name = format!("Large picture of {}", model.time(tick));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, &name));
    paint(ui, rect, model.timeline.picture_at(tick), pictures);
}

/// Shows the picture of a moment beside the mouse.
pub(super) fn show_large_at_pointer(
    ui: &Ui,
    model: &Model,
    tick: SimTick,
    pictures: &mut Pictures,
) {
    let screen = ui.ctx().viewport_rect();
    let pointer = ui.ctx().pointer_latest_pos().unwrap_or(screen.center());
    let size = LARGE + vec2(20.0, 60.0);
    let above = pointer - vec2(LARGE.x / 2.0, size.y + 50.0);
    let below = pointer + vec2(-LARGE.x / 2.0, 50.0);
    let place = match above.y >= screen.min.y {
        true => above,
        false => below,
    };
    let farthest: Pos2 = (screen.max - size).max(screen.min);
    Area::new(Id::new("timeline picture"))
        .order(Order::Tooltip)
        .fixed_pos(place.clamp(screen.min, farthest))
        .interactable(false)
        .show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(LARGE.x);
                show_large(ui, model, tick, pictures);
                ui.label(track::caption_at(model, tick));
            });
        });
}

fn paint(ui: &Ui, rect: Rect, picture: Option<&TimelinePicture>, pictures: &mut Pictures) {
    let painter = ui.painter();
    painter.rect_filled(rect, 0.0, MISSING);
    if let Some(texture) = picture.and_then(|picture| pictures.texture(ui.ctx(), picture)) {
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let shape = texture.aspect_ratio();
        let fitted = match shape > rect.aspect_ratio() {
            true => vec2(rect.width(), rect.width() / shape),
            false => vec2(rect.height() * shape, rect.height()),
        };
        let place = Rect::from_center_size(rect.center(), fitted);
        painter.image(texture.id(), place, whole, Color32::WHITE);
    }
}
