//! The buttons that move the playhead and set its pace.

use bevy_egui::egui::{Button, Response, Ui, WidgetInfo, WidgetType};
use tabletop_core::{SimTick, TimelineStage};
use tabletop_user::{Action, Pace};

use super::model::{Model, Request};

/// Ticks from one frame of a recording to the next.
const FRAME: u64 = 15;

/// Later than this after the beginning of a segment, the way back leads there.
const REPEAT: u64 = 30;

/// Shows the buttons, and returns their requests.
pub(super) fn show(ui: &mut Ui, model: &Model) -> Vec<Request> {
    let mut requests = playing(ui, model);
    ui.separator();
    requests.extend(pace(ui, model));
    ui.separator();
    requests.extend(recording(ui, model));
    requests
}

fn playing(ui: &mut Ui, model: &Model) -> Vec<Request> {
    let tip = |action| model.keymap.tooltip(action);
    let now = model.playhead();
    let (back, forth) = (
        |ticks| Request::StopAt(SimTick(now.0.saturating_sub(ticks))),
        |ticks| Request::StopAt(SimTick(now.0 + ticks)),
    );
    let (play, other) = match model.is_paused {
        true => (("▶", "Play", tip(Action::Pause)), Request::Play),
        false => (("⏸", "Pause", tip(Action::Pause)), Request::Pause),
    };
    let step = ("⏵", "Step", tip(Action::Step));
    let buttons = if model.is_open() {
        let segment = |forward| Request::GoTo(neighbour(model, forward));
        vec![
            (
                (
                    "⏮",
                    "Previous segment",
                    "Go to the beginning of the segment, then to the one before".into(),
                ),
                segment(false),
            ),
            (
                (
                    "⏪",
                    "Back one frame",
                    "Go back by a frame, a quarter of a second".into(),
                ),
                back(FRAME),
            ),
            (
                (
                    "⏴",
                    "Back one tick",
                    "Go back by a tick, 1/60 of a second".into(),
                ),
                back(1),
            ),
            (play, other),
            (step, Request::Step),
            (
                (
                    "⏩",
                    "Forward one frame",
                    "Go on by a frame, a quarter of a second".into(),
                ),
                forth(FRAME),
            ),
            (
                (
                    "⏭",
                    "Next segment",
                    "Go to the beginning of the next segment".into(),
                ),
                segment(true),
            ),
        ]
    } else {
        vec![(play, other), (step, Request::Step)]
    };
    let is_going = model.playback.goal.is_some();
    let mut requests = Vec::new();
    for ((symbol, name, tooltip), request) in buttons {
        let response = ui.add_enabled(!is_going, Button::new(symbol));
        if named(response, name, tooltip).clicked() {
            requests.push(request);
        }
    }
    requests
}

/// The first tick of the next segment, or of the one before; of the present one if it began a while ago.
fn neighbour(model: &Model, forward: bool) -> SimTick {
    let timeline = model.timeline;
    let now = model.playhead();
    let present = timeline.segment_at(now).unwrap_or(0);
    let start = |number: usize| timeline.segments.get(number).map(|segment| segment.start);
    if forward {
        return start(present + 1).unwrap_or(timeline.end);
    }
    let is_later = start(present).is_some_and(|start| now.0 > start.0 + REPEAT);
    let number = match is_later {
        true => present,
        false => present.saturating_sub(1),
    };
    start(number).unwrap_or(timeline.start)
}

fn pace(ui: &mut Ui, model: &Model) -> Vec<Request> {
    let mut requests = Vec::new();
    let keys = |pace: Pace| match pace.cmp(&model.pace) {
        std::cmp::Ordering::Less => model.keymap.hint(Action::Slower),
        std::cmp::Ordering::Equal => String::new(),
        std::cmp::Ordering::Greater => model.keymap.hint(Action::Faster),
    };
    for pace in Pace::ALL {
        let is_present = pace == model.pace;
        let response = ui.add(Button::new(pace.label()).selected(is_present));
        let mut tooltip = format!("Simulate at {} of real time", pace.label());
        let keys = keys(pace);
        if !keys.is_empty() {
            tooltip = format!("{tooltip} ({keys})");
        }
        let name = format!("Pace {}", pace.label());
        if named(response, &name, tooltip).clicked() && !is_present {
            requests.push(Request::SetPace(pace));
        }
    }
    requests
}

fn recording(ui: &mut Ui, model: &Model) -> Vec<Request> {
    let mut requests = Vec::new();
    let timeline = model.timeline;
    match timeline.stage {
        TimelineStage::Absent | TimelineStage::Running => {}
        TimelineStage::Finished => {
            let open = ui.button("Open");
            let tooltip = format!("Play the recording in {}", timeline.folder.display());
            if open.on_hover_text(tooltip).clicked() {
                requests.push(Request::Open(timeline.folder.clone()));
            }
        }
        TimelineStage::Open => {
            let loops = model.playback.loops;
            let switch = ui.add(Button::new("Loop").selected(loops));
            if switch.on_hover_text("Begin again at the end").clicked() {
                requests.push(Request::Loop(!loops));
            }
            let close = ui.button("Close");
            if close
                .on_hover_text("Close the recording, and begin with a fresh task")
                .clicked()
            {
                requests.push(Request::Close);
            }
        }
    }
    match timeline.stage {
        TimelineStage::Absent | TimelineStage::Running => {}
        TimelineStage::Finished | TimelineStage::Open => {
            let video = ui.button("Save video");
            let tooltip = "Save the recording, seen from here, as a video (.mp4, .gif) or a contact sheet (.png)";
            if video.on_hover_text(tooltip).clicked() {
                requests.push(Request::SaveVideo);
            }
        }
    }
    requests
}

/// A button with a symbol, and words for those who do not see it.
fn named(response: Response, name: &str, tooltip: String) -> Response {
    let is_enabled = response.enabled();
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, is_enabled, name));
    response.on_hover_text(tooltip)
}
