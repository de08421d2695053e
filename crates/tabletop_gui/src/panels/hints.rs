//! The hints of the first start: how things are moved, until the user has read them.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Align2, Area, Context, Frame, Id, Order, Rect, RichText, Ui, vec2},
};
use serde::{Deserialize, Serialize};
use tabletop_user::{Action, Dragging, Keymap};

use crate::{
    kept::{Kept, keep},
    panels::{arrangement::Panels, window::free_desk},
    widgets::{button::button, style::GAP},
};

/// Width of the longest line, in points.
const WIDTH: f32 = 420.0;

/// Nobody is at the window who could read hints.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Unattended;

/// What the user has read.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Hints {
    are_read: bool,
}

impl Kept for Hints {
    const CONCERN: &'static str = "hints";
}

/// A wish of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Dismiss,
    DragLevel(bool),
}

pub(crate) fn plugin(app: &mut App) {
    keep::<Hints>(app);
    app.add_systems(
        EguiPrimaryContextPass,
        show_hints
            .run_if(|hints: Res<Hints>| !hints.are_read)
            .run_if(not(resource_exists::<Unattended>)),
    );
}

fn show_hints(
    mut contexts: EguiContexts,
    keymap: Res<Keymap>,
    panels: Res<Panels>,
    mut hints: ResMut<Hints>,
    mut dragging: ResMut<Dragging>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let desk = free_desk(context, &panels);
    match show(context, desk, &keymap, dragging.is_level) {
        Some(Request::Dismiss) => hints.are_read = true,
        Some(Request::DragLevel(is_level)) => dragging.is_level = is_level,
        None => {}
    }
}

/// Shows the hints at the lower edge of the desk.
fn show(context: &Context, desk: Rect, keymap: &Keymap, is_level: bool) -> Option<Request> {
    let below = context.viewport_rect().bottom() - desk.bottom();
    Area::new(Id::new("hints"))
        .order(Order::Middle)
        .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -below - GAP))
        .fade_in(false)
        .show(context, |ui| {
            let frame = Frame::window(ui.style());
            frame.show(ui, |ui| lines(ui, keymap, is_level)).inner
        })
        .inner
}

fn lines(ui: &mut Ui, keymap: &Keymap, is_level: bool) -> Option<Request> {
    ui.set_max_width(WIDTH);
    let first = match is_level {
        true => "Drag a block: it goes along the table and onto other blocks.",
        false => "Click a block and drag it in the blue plane; press beside it to let it go.",
    };
    ui.label(RichText::new(first).strong());
    ui.label("Drag with the right button to look around; the wheel goes nearer and farther.");
    let [help, undo, choose] = [Action::ShowHelp, Action::Undo, Action::NextObject]
        .map(|action| keymap.bindings(action).first().map(|key| key.label()));
    let keys = [
        (help, "shows all keys"),
        (undo, "undoes"),
        (choose, "chooses a block for the arrow keys"),
    ];
    let keys = keys
        .into_iter()
        .filter_map(|(key, what)| Some(format!("{} {what}", key?)));
    ui.label(format!("{}.", keys.collect::<Vec<_>>().join(", ")));
    let row = ui.horizontal(|ui| {
        let mut wished = is_level;
        let level = ui.checkbox(&mut wished, "Drag along the table");
        let level = level.on_hover_text("Also in Pose and Dragging");
        let dismiss = button(ui, true, "Got it", "Never show this again").clicked();
        match (dismiss, level.changed()) {
            (true, _) => Some(Request::Dismiss),
            (false, true) => Some(Request::DragLevel(wished)),
            (false, false) => None,
        }
    });
    row.inner
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    fn harness(is_level: bool) -> Harness<'static, Option<Request>> {
        let keymap = Keymap::default();
        let frame = move |ui: &mut Ui, request: &mut Option<Request>| {
            let desk = free_desk(ui.ctx(), &Panels::default());
            *request = show(ui.ctx(), desk, &keymap, is_level).or(*request);
        };
        let mut harness = Harness::new_ui_state(frame, None);
        harness.run();
        harness
    }

    #[test]
    fn the_hints_are_dismissed_and_offer_to_drag_along_the_table() {
        for (name, expected) in [
            ("Got it", Request::Dismiss),
            ("Drag along the table", Request::DragLevel(true)),
        ] {
            let mut harness = harness(false);
            harness.get_by_label(name).click();
            harness.run();
            assert_eq!(*harness.state(), Some(expected));
        }
    }

    #[test]
    fn the_hints_fit_the_way_of_dragging() {
        for (is_level, beginning) in [(false, "Click a block and drag"), (true, "Drag a block")] {
            let harness = harness(is_level);
            assert!(harness.query_by_label_contains(beginning).is_some());
        }
        let keys = "F1 shows all keys, Ctrl+Z undoes, Tab chooses a block for the arrow keys.";
        assert!(harness(false).query_by_label(keys).is_some());
    }
}
