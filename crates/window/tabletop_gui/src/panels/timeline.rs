//! The Timeline: the recording that is made or open, with its segments, its pictures and a playhead.

mod axis;
mod edits;
mod film;
mod lesson;
mod meaning;
mod model;
mod orders;
mod segment_ends;
mod selected_segments;
mod sentences;
mod track;
mod transport;
mod view;
mod zoom;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Ui},
};
use tabletop_core::{History, Paused, Playback, ShownTask, SimTick, Timeline, TimelineStage};
use tabletop_user::{EditOrder, Editing, Imitating, Keymap, TaughtProgram};

use self::{
    model::{Model, Moment, Request},
    view::View,
    zoom::Zoom,
};
use crate::panels::{Panel, Panels};

/// Advice where there is no recording.
const ABSENT: &str = "There is no recording. Start one in Demonstration Tools, or open one: drop its folder onto the window.";

/// From this width on, in points, the lesson stands beside the recording, else below it.
const WIDE: f32 = 900.0;

/// The width of the lesson beside the recording, in points.
const LESSON: f32 = 330.0;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<View>()
        .add_plugins((edits::plugin, orders::plugin))
        .add_systems(Update, open_with_recording)
        .add_systems(EguiPrimaryContextPass, show_panel);
}

/// Shows the panel's contents, and returns the user's requests.
fn show(ui: &mut Ui, model: &Model, view: &mut View) -> Vec<Request> {
    if lesson::is_empty(model) {
        return show_recording(ui, model, view);
    }
    let width = ui.available_width();
    if width < WIDE {
        let mut requests = show_recording(ui, model, view);
        ui.separator();
        requests.extend(lesson::show(ui, model));
        return requests;
    }
    let beside = |ui: &mut Ui| {
        let recording = |ui: &mut Ui| {
            ui.set_width(width - LESSON - 2.0 * ui.spacing().item_spacing.x);
            show_recording(ui, model, view)
        };
        let mut requests = ui.vertical(recording).inner;
        ui.separator();
        requests.extend(ui.vertical(|ui| lesson::show(ui, model)).inner);
        requests
    };
    ui.horizontal_top(beside).inner
}

/// Shows the buttons, and the recording along its time.
fn show_recording(ui: &mut Ui, model: &Model, view: &mut View) -> Vec<Request> {
    view.pictures.begin_frame(&model.timeline.folder);
    view.selection.begin_frame(model.timeline);
    let is_absent = model.timeline.stage == TimelineStage::Absent;
    let mut requests = Vec::new();
    ui.horizontal_wrapped(|ui| {
        requests = transport::show(ui, model);
        if !is_absent {
            ui.separator();
            view.zoom.buttons(ui, model);
        }
    });
    if is_absent {
        view.looked_at = None;
        ui.label(ABSENT);
        return requests;
    }
    if view.zoomed != model.timeline.folder {
        view.zoomed.clone_from(&model.timeline.folder);
        view.zoom = Zoom::default();
    }
    if !model.is_paused || model.playback.goal.is_some() {
        view.zoom.follow(model.timeline, model.playhead());
    }
    let (rect, _) = ui.allocate_exact_size(
        egui::vec2(ui.available_width(), track::HEIGHT),
        egui::Sense::hover(),
    );
    let axis = view.zoom.axis(model.timeline, rect.x_range());
    view.zoom.turn_wheel(ui, model.timeline, axis, rect);
    let mut moments = track::show(ui, model, axis, rect, &mut view.selection);
    let retimed = segment_ends::show(ui, model, axis, track::lane(rect), &view.selection);
    requests.extend(retimed.map(|edit| Request::Edit(EditOrder::Edit(edit))));
    moments.extend(sentences::show(ui, model, axis));
    moments.extend(film::show(ui, model, axis, &mut view.pictures));
    let mut dragged_to = None;
    for moment in moments {
        match moment {
            Moment::Dragged(tick) => dragged_to = Some(tick),
            Moment::Chosen(tick) if model.is_open() => requests.push(Request::GoTo(tick)),
            Moment::Chosen(tick) => view.looked_at = Some(tick),
        }
    }
    view.dragged_to = dragged_to;
    if let Some(tick) = dragged_to {
        film::show_large_at_pointer(ui, model, tick, &mut view.pictures);
    }
    if model.is_open() {
        view.looked_at = None;
    }
    requests.extend(show_segment(ui, model, view));
    let edits = edits::show(ui, model, &view.selection);
    requests.extend(edits.into_iter().map(Request::Edit));
    requests
}

/// The segment of the playhead, or of the moment that the user looks at.
fn show_segment(ui: &mut Ui, model: &Model, view: &mut View) -> Vec<Request> {
    let mut requests = Vec::new();
    let tick = view.dragged_to.or(view.looked_at);
    let tick = tick.unwrap_or_else(|| model.playhead());
    let Some(number) = model.timeline.segment_at(tick) else {
        return requests;
    };
    ui.horizontal(|ui| {
        if let Some(color) = model.segment(number).and_then(|segment| segment.color) {
            let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(14.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 2.0, track::color(color));
        }
        ui.strong(model.sentence(number));
        let (start, end) = (
            model.timeline.segments[number].start,
            model.timeline.end_of(number),
        );
        ui.weak(format!("{} – {}", model.time(start), model.time(end)));
        let right = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(right, |ui| ui.label(model.progress()));
    });
    if model.timeline.stage == TimelineStage::Running {
        let later = model.timeline.segments.len().saturating_sub(number);
        let count = later.min(model.history.undoable);
        ui.horizontal(|ui| {
            let segments = match count {
                1 => "this segment".to_owned(),
                count => format!("this segment and all after it: {count} segments"),
            };
            let undo = ui
                .add_enabled(
                    number > 0 && count > 0,
                    egui::Button::new("Undo back to here"),
                )
                .on_hover_text(format!("Undo {segments}"))
                .on_disabled_hover_text("The first segment cannot be undone");
            if undo.clicked() {
                view.looked_at = None;
                requests.push(Request::Undo(count));
            }
            let redo = ui
                .add_enabled(model.history.redoable > 0, egui::Button::new("Redo"))
                .on_hover_text("Bring back the segment that was undone last")
                .on_disabled_hover_text("Nothing was undone");
            if redo.clicked() {
                requests.push(Request::Redo);
            }
        });
    }
    if let Some(tick) = view.looked_at {
        ui.horizontal(|ui| {
            ui.label(format!("The picture of {}", model.time(tick)));
            let back = ui.button("Back to now");
            if back.on_hover_text("Look at the present again").clicked() {
                view.looked_at = None;
            }
        });
        film::show_large(ui, model, tick, &mut view.pictures);
    }
    requests
}

/// The panel opens with a recording.
fn open_with_recording(
    timeline: Res<Timeline>,
    mut stage: Local<TimelineStage>,
    mut panels: ResMut<Panels>,
) {
    let is_new = *stage != timeline.stage;
    *stage = timeline.stage;
    if is_new && timeline.stage == TimelineStage::Open {
        panels.set_open(Panel::Timeline, true);
    }
}

/// The resources from which the model is made.
#[derive(SystemParam)]
struct Sources<'w> {
    timeline: Res<'w, Timeline>,
    playback: Res<'w, Playback>,
    tick: Res<'w, SimTick>,
    paused: Res<'w, Paused>,
    history: Res<'w, History>,
    keymap: Res<'w, Keymap>,
    task: Res<'w, ShownTask>,
    taught: Res<'w, TaughtProgram>,
    imitating: Res<'w, Imitating>,
    editing: Res<'w, Editing>,
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    source: Sources,
    mut view: ResMut<View>,
    mut orders: orders::Orders,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let model = Model {
        timeline: &source.timeline,
        playback: *source.playback,
        shown: SimTick(source.tick.0.saturating_sub(1)),
        is_paused: source.paused.0,
        pace: orders.pace(),
        history: *source.history,
        keymap: &source.keymap,
        task: &source.task,
        taught: &source.taught,
        imitating: &source.imitating,
        editing: &source.editing,
    };
    let mut requests = Vec::new();
    Panel::Timeline.show(context, &mut panels, |ui| {
        requests = show(ui, &model, &mut view);
    });
    for request in requests {
        orders.carry_out(request);
    }
}

#[cfg(test)]
mod tests;
