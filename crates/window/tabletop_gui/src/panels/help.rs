//! The sheet that says what keys and mouse do.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use tabletop_user::{Action, ActionGroup, KeySystems, Keymap, Way, was_struck};

/// The number of columns.
const COLUMNS: usize = 3;

/// The column of a group, from left to right.
const fn column_of(group: ActionGroup) -> usize {
    match group {
        ActionGroup::Simulation
        | ActionGroup::Demonstration
        | ActionGroup::Objects
        | ActionGroup::Window => 0,
        ActionGroup::Camera | ActionGroup::Chosen | ActionGroup::Robot => 1,
        ActionGroup::Limb(_) => 2,
    }
}

/// The actions of the mouse beside the panels.
const MOUSE: [(&str, &str, &str); 8] = [
    (
        "click",
        "Take an object",
        "The selected hand takes the object under the cursor",
    ),
    (
        "drag",
        "Move what is held",
        "The held object moves in the blue plane",
    ),
    (
        "drag an object",
        "Take, move, let go",
        "If Along the table is on in Pose and Dragging; the wheel raises the object",
    ),
    (
        "drag an arrow",
        "Turn what is held",
        "The held object turns about the axis whose arrow is dragged",
    ),
    (
        "press elsewhere",
        "Let go",
        "The selected hand releases its object",
    ),
    (
        "right drag",
        "Go round",
        "The camera orbits the point under the cursor",
    ),
    (
        "middle drag",
        "Move along",
        "The camera keeps a point under the cursor; so does Shift with the right button",
    ),
    (
        "wheel",
        "Nearer, farther",
        "The camera goes towards the point under the cursor, or away from it",
    ),
];

/// Sizes in points.
const COLUMN_WIDTH: f32 = 290.0;
const COLUMN_GAP: f32 = 28.0;
const KEY_GAP: f32 = 12.0;
const LINE_GAP: f32 = 3.0;
const MARGIN: f32 = 48.0;
const FRAME_HEIGHT: f32 = 96.0;

const FOOTNOTE: &str =
    "Keys are named by their places on a US keyboard, whatever is printed on them.";

/// The state of the sheet: shown or hidden.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Help {
    is_open: bool,
}

impl Help {
    /// Shows the sheet, or hides it.
    pub const fn toggle(&mut self) {
        self.is_open = !self.is_open;
    }

    /// True if the sheet is shown.
    pub const fn is_open(self) -> bool {
        self.is_open
    }
}

/// The content of the sheet: groups with their lines, column by column.
#[derive(Clone, Debug, PartialEq)]
struct KeySheet {
    columns: Vec<Vec<Group>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Group {
    name: String,
    lines: Vec<Line>,
}

/// An action and its keys.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    label: String,
    keys: String,
    tooltip: String,
}

/// A wish of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Close,
}

impl KeySheet {
    fn of(keymap: &Keymap) -> Self {
        let mut columns = vec![Vec::new(); COLUMNS];
        for (group, name) in keymap.groups() {
            columns[column_of(group)].push(Group::of(group, name, keymap));
        }
        if let Some(last) = columns.last_mut() {
            last.push(Group::mouse());
        }
        Self { columns }
    }
}

impl Group {
    fn of(group: ActionGroup, name: &str, keymap: &Keymap) -> Self {
        let lines = keymap.actions_of(group);
        Self {
            name: name.to_owned(),
            lines: lines
                .filter_map(|action| Line::of(action, keymap))
                .collect(),
        }
    }

    fn mouse() -> Self {
        let lines = MOUSE.map(|(keys, label, tooltip)| Line {
            label: label.to_owned(),
            keys: keys.to_owned(),
            tooltip: tooltip.to_owned(),
        });
        Self {
            name: "Mouse".to_owned(),
            lines: lines.into(),
        }
    }
}

impl Line {
    /// A joint has one line for both ways.
    fn of(action: Action, keymap: &Keymap) -> Option<Self> {
        let hint = keymap.hint(action);
        let label = keymap.label(action);
        let (label, hint) = if let Action::Move(joint, way) = action
            && label.ends_with(way.sign())
        {
            if way == Way::Minus {
                return None;
            }
            let back = keymap.hint(Action::Move(joint, Way::Minus));
            let label = label.replace('+', "+ / −");
            (label, format!("{} / {}", or_none(hint), or_none(back)))
        } else {
            (label.to_owned(), or_none(hint))
        };
        Some(Self {
            label,
            keys: hint,
            tooltip: keymap.description(action).to_owned(),
        })
    }
}

fn or_none(hint: String) -> String {
    if hint.is_empty() {
        "–".to_owned()
    } else {
        hint
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Help>()
        .add_systems(
            RunFixedMainLoop,
            (|mut help: ResMut<Help>| help.toggle())
                .run_if(was_struck(Action::ShowHelp))
                .in_set(KeySystems),
        )
        .add_systems(
            EguiPrimaryContextPass,
            show_help.run_if(|help: Res<Help>| help.is_open),
        );
}

fn show_help(mut contexts: EguiContexts, keymap: Res<Keymap>, mut help: ResMut<Help>) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    match show_sheet(context, &KeySheet::of(&keymap)) {
        Some(Request::Close) => help.is_open = false,
        None => {}
    }
}

/// Shows the sheet over everything else, also over the overlay of a pause.
fn show_sheet(context: &egui::Context, sheet: &KeySheet) -> Option<Request> {
    let id = egui::Id::new("help");
    let layer = egui::Modal::default_area(id).layer();
    // The click that opened the sheet does not close it.
    let was_shown = context.memory(|memory| memory.top_modal_layer() == Some(layer));
    context.move_to_top(layer);
    let modal = egui::Modal::new(id).show(context, |ui| show(ui, sheet));
    let is_clicked = was_shown && context.input(|input| input.pointer.any_click());
    (is_clicked || modal.should_close())
        .then_some(Request::Close)
        .or(modal.inner)
}

fn show(ui: &mut egui::Ui, sheet: &KeySheet) -> Option<Request> {
    let mut is_closed = false;
    let screen = ui.ctx().content_rect().size() - egui::Vec2::splat(MARGIN);
    let shown_columns = (screen.x / COLUMN_WIDTH).floor().max(1.0) as usize;
    ui.horizontal(|ui| {
        ui.heading("Keys and mouse");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let button = ui.button("Close").on_hover_text("Closes this sheet (Esc)");
            is_closed = button.clicked();
        });
    });
    ui.separator();
    let highest = screen.y - FRAME_HEIGHT;
    let scroll = egui::ScrollArea::vertical()
        .max_height(highest)
        .min_scrolled_height(highest);
    scroll.show(ui, |ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        for columns in sheet.columns.chunks(shown_columns) {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = COLUMN_GAP;
                columns.iter().for_each(|column| show_column(ui, column));
            });
        }
    });
    ui.separator();
    ui.weak(FOOTNOTE);
    is_closed.then_some(Request::Close)
}

fn show_column(ui: &mut egui::Ui, groups: &[Group]) {
    let first = groups.first().map(|group| &group.name);
    let grid = egui::Grid::new(first).num_columns(2);
    grid.spacing([KEY_GAP, LINE_GAP]).show(ui, |ui| {
        for group in groups {
            if Some(&group.name) != first {
                ui.end_row();
            }
            ui.strong(&group.name);
            ui.end_row();
            for line in &group.lines {
                ui.monospace(&line.keys);
                ui.label(&line.label).on_hover_text(&line.tooltip);
                ui.end_row();
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use egui_kittest::{Harness, kittest::Queryable as _};

    /// The sheet in a window, and whether it was closed.
    fn harness(size: egui::Vec2) -> Harness<'static, Option<Request>> {
        let sheet = KeySheet::of(&Keymap::default());
        Harness::builder().with_size(size).build_ui_state(
            move |ui, request| *request = show_sheet(ui.ctx(), &sheet).or(*request),
            None,
        )
    }

    #[test]
    fn every_group_stands_in_one_column() {
        let keymap = Keymap::default();
        let shown = KeySheet::of(&keymap).columns.concat();
        let mut shown: Vec<_> = shown.into_iter().map(|group| group.name).collect();
        shown.sort();
        let mut all: Vec<_> = keymap.groups().map(|(_, name)| name.to_owned()).collect();
        all.push("Mouse".to_owned());
        all.sort();
        assert_eq!(shown, all);
    }

    #[test]
    fn lines_say_the_present_keys() {
        let mut keymap = Keymap::default();
        keymap.bind(Action::Pause, ["F5".parse().unwrap()]);
        keymap.bind(Action::Quit, []);
        let line = |action| Line::of(action, &keymap).map(|line| (line.label, line.keys));
        let some = |label: &str, keys: &str| Some((label.to_owned(), keys.to_owned()));
        assert_eq!(line(Action::Pause), some("Pause, resume", "F5"));
        assert_eq!(line(Action::Quit), some("Quit", "–"));
        let w2 = |way| Action::Move(tabletop_core::RobotJoint::RightW2.name(), way);
        assert_eq!(line(w2(Way::Plus)), some("W2 + / −", "T / Shift+T"));
        assert_eq!(line(w2(Way::Minus)), None);
    }

    #[test]
    fn the_sheet_shows_every_line() {
        for size in [egui::vec2(1024.0, 768.0), egui::vec2(400.0, 300.0)] {
            let harness = harness(size);
            harness.get_by_label("Pause, resume");
            harness.get_by_label("Nearer, farther");
            assert_eq!(harness.get_all_by_label("Open gripper").count(), 2);
        }
    }

    #[test]
    fn the_key_shows_and_hides_the_sheet() {
        let mut test = TestWorld::new(plugin);
        for is_open in [true, false] {
            test.keys().press(KeyCode::F1);
            for _ in 0..2 {
                test.hold_still();
                assert_eq!(test.app.world().resource::<Help>().is_open(), is_open);
            }
            test.keys().release(KeyCode::F1);
        }
    }

    #[test]
    fn button_escape_and_a_click_close_the_sheet() {
        let close: [fn(&mut Harness<'static, Option<Request>>); 3] = [
            |harness| harness.get_by_label("Close").click(),
            |harness| harness.key_press(egui::Key::Escape),
            |harness| {
                let pos = egui::pos2(3.0, 3.0);
                for pressed in [true, false] {
                    harness.event(egui::Event::PointerButton {
                        pos,
                        button: egui::PointerButton::Primary,
                        pressed,
                        modifiers: egui::Modifiers::NONE,
                    });
                }
            },
        ];
        for close in close {
            let mut harness = harness(egui::vec2(1024.0, 768.0));
            harness.run();
            assert_eq!(*harness.state(), None);
            close(&mut harness);
            harness.run();
            assert_eq!(*harness.state(), Some(Request::Close));
        }
    }
}
