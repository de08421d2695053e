//! The hints of the first start: how things are moved, until the user has read them.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Align2, Area, Context, Frame, Id, LayerId, Order, Rect, RichText, Ui, vec2},
};
use serde::{Deserialize, Serialize};
use tabletop_user::{Action, Dragging, Keymap};

use crate::{
    kept::{Kept, keep},
    panels::{arrangement::Panels, panel::Panel, window::free_desk},
    widgets::{
        button::button,
        style::{GAP, MARGIN},
    },
};

/// Width of the longest line, and the least width of lines, in points.
const WIDTH: f32 = 500.0;
const NARROWEST: f32 = 280.0;

/// As high as the hints may be, in points.
const HEIGHT: f32 = 120.0;

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
    match show(context, &panels, &keymap, dragging.is_level) {
        Some(Request::Dismiss) => hints.are_read = true,
        Some(Request::DragLevel(is_level)) => dragging.is_level = is_level,
        None => {}
    }
}

fn layer() -> LayerId {
    LayerId::new(Order::Middle, Id::new("hints"))
}

/// Lower edge of the hints, if they are shown at the upper edge of the desk.
pub(crate) fn bottom(context: &Context) -> Option<f32> {
    let shown = context.memory(|memory| {
        let is_shown = memory.areas().is_visible(&layer());
        memory.area_rect(layer().id).filter(|_| is_shown)
    })?;
    (shown.top() <= HEIGHT).then_some(shown.bottom())
}

/// Shows the hints at the upper edge of the desk, over the room behind the table, or at the lower one if panels leave no room there.
fn show(context: &Context, panels: &Panels, keymap: &Keymap, is_level: bool) -> Option<Request> {
    let (screen, desk) = (context.viewport_rect(), free_desk(context, panels));
    let room = free_top(context, panels, desk);
    let width = room.width() - 2.0 * (GAP + f32::from(MARGIN));
    let (align, offset, width) = match width >= NARROWEST {
        true => {
            let middle = room.center().x - screen.center().x;
            (Align2::CENTER_TOP, vec2(middle, GAP), width.min(WIDTH))
        }
        false => {
            let below = screen.bottom() - desk.bottom();
            (Align2::CENTER_BOTTOM, vec2(0.0, -below - GAP), WIDTH)
        }
    };
    Area::new(layer().id)
        .order(layer().order)
        .anchor(align, offset)
        .fade_in(false)
        .show(context, |ui| {
            ui.set_max_width(width);
            let frame = Frame::window(ui.style());
            frame.show(ui, |ui| lines(ui, keymap, is_level)).inner
        })
        .inner
}

/// The widest part of the desk's upper edge that no panel covers.
fn free_top(context: &Context, panels: &Panels, desk: Rect) -> Rect {
    let edge = desk.with_max_y(desk.top() + HEIGHT);
    let open = Panel::ALL
        .into_iter()
        .filter(|&panel| panels.is_open(panel));
    let covers = open.filter_map(|panel| panel.rect(context));
    let mut covers: Vec<_> = covers.filter(|cover| cover.intersects(edge)).collect();
    covers.sort_by(|one, other| one.left().total_cmp(&other.left()));
    let beyond = Rect::everything_right_of(edge.right());
    let mut left = edge.left();
    let gaps = covers.into_iter().chain([beyond]).map(|cover| {
        let gap = edge.with_min_x(left).with_max_x(cover.left());
        left = left.max(cover.right());
        gap
    });
    let widest = gaps.max_by(|one, other| one.width().total_cmp(&other.width()));
    widest.unwrap_or(edge)
}

fn lines(ui: &mut Ui, keymap: &Keymap, is_level: bool) -> Option<Request> {
    let first = match is_level {
        true => "Drag a block: it goes along the table and onto other blocks.",
        false => "Drag a block: it moves in the blue plane; press beside it to let it go.",
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
            let panels = Panels::default();
            *request = show(ui.ctx(), &panels, &keymap, is_level).or(*request);
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
    fn the_hints_are_beside_the_panels_over_the_room_or_below_if_these_leave_no_place() {
        let keymap = Keymap::default();
        let frame = move |ui: &mut Ui, panels: &mut Panels| {
            for panel in Panel::ALL {
                let content = |ui: &mut Ui| ui.allocate_space(vec2(10.0, 120.0));
                panel.show(ui.ctx(), panels, content);
            }
            show(ui.ctx(), panels, &keymap, false);
        };
        let size = vec2(900.0, 600.0);
        let mut harness = Harness::builder()
            .with_size(size)
            .build_ui_state(frame, Panels::default());
        harness.run();
        let hints = |harness: &Harness<Panels>| {
            let rect = harness.ctx.memory(|memory| memory.area_rect(layer().id));
            rect.unwrap()
        };
        let status = harness.get_by_label("Status").rect();
        let beside = hints(&harness);
        assert!(beside.left() >= status.right() && beside.right() <= size.x);
        // The far edge of a table is lower in the first view.
        assert!(beside.bottom() < size.y / 4.0, "{beside}");
        assert_eq!(bottom(&harness.ctx), Some(beside.bottom()));
        harness.state_mut().set_open(Panel::Objects, true);
        harness.run_steps(4);
        let below = hints(&harness);
        assert!(below.top() > size.y / 2.0, "{below}");
        assert_eq!(bottom(&harness.ctx), None);
    }

    #[test]
    fn the_hints_fit_the_way_of_dragging() {
        for (is_level, beginning) in [
            (false, "Drag a block: it moves"),
            (true, "Drag a block: it goes"),
        ] {
            let harness = harness(is_level);
            assert!(harness.query_by_label_contains(beginning).is_some());
        }
        let keys = "F1 shows all keys, Ctrl+Z undoes, Tab chooses a block for the arrow keys.";
        assert!(harness(false).query_by_label(keys).is_some());
    }
}
