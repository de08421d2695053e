//! The joint that the user has selected, and how he moves it.

use bevy_egui::egui::{Button, ComboBox, Key, Response, RichText, Slider, Ui, WidgetType};
use tabletop_core::{JointId, RobotLayout};
use tabletop_user::{Action, Way};

use super::{
    model::{Model, Request, RobotInput},
    reading::{number, unit},
};
use crate::widgets::{button::hold_button, name::name, typed_number::TypedRange};

/// Width of the track of the slider, in points.
pub(super) const TRACK_WIDTH: f32 = 196.0;

/// The reason why joints cannot be moved by hand.
const SCRIPT_MOVES: &str = "a script moves the arms";

/// So high that the list of joints needs no scroll bar, in points.
const LIST_HEIGHT: f32 = 400.0;

/// The joint that the user has selected.
pub(super) struct JointSelection {
    pub joint: JointId,
    /// The position to which the user has sent it, while it is under way.
    pub goal: Option<f64>,
}

impl Default for JointSelection {
    fn default() -> Self {
        Self {
            joint: JointId(0),
            goal: None,
        }
    }
}

/// Selects a joint, and moves it while a button is held down.
pub(super) fn joint(
    ui: &mut Ui,
    model: &Model,
    selection: &mut JointSelection,
    input: &mut RobotInput,
) {
    ui.horizontal(|ui| {
        let joint = chosen_joint(ui, model.layout, selection.joint);
        if joint != selection.joint {
            *selection = JointSelection { joint, goal: None };
        }
        for (text, direction, way) in [("−", -1, Way::Minus), ("+", 1, Way::Plus)] {
            let button = hold_button(
                ui,
                model.is_free(joint),
                RichText::new(text).strong().monospace(),
                &tooltip(model, joint, way),
                SCRIPT_MOVES,
            );
            if button.is_held {
                input.pressed.held.set(joint, direction);
            }
            if button.was_struck {
                input.pressed.struck.set(joint, direction);
            }
        }
        let home = "Bring every joint back to its home position";
        let home = ui
            .add_enabled(!model.is_scripted, Button::new("Home"))
            .on_hover_text(home)
            .on_disabled_hover_text(SCRIPT_MOVES);
        if home.clicked() {
            input.requests.push(Request::GoHome);
            selection.goal = None;
        }
    });
}

/// The action of a button, and its keys.
fn tooltip(model: &Model, joint: JointId, way: Way) -> String {
    let joint = model.layout.joint(joint).name;
    model.keymap.tooltip(Action::Move(joint, way))
}

fn chosen_joint(ui: &mut Ui, layout: &RobotLayout, before: JointId) -> JointId {
    let mut joint = before;
    let list = ComboBox::from_id_salt("joint")
        .selected_text(layout.label_of(joint))
        .width(120.0)
        .height(LIST_HEIGHT)
        .show_ui(ui, |ui| {
            for choice in layout.joint_ids() {
                ui.selectable_value(&mut joint, choice, layout.label_of(choice));
            }
        });
    name(&list.response, WidgetType::ComboBox, "Joint");
    list.response.on_hover_text("The joint to be moved");
    joint
}

/// Sends the selected joint somewhere.
pub(super) fn goal(
    ui: &mut Ui,
    model: &Model,
    selection: &mut JointSelection,
    requests: &mut Vec<Request>,
) {
    let joint = selection.joint;
    let state = model.robot.joint(joint);
    let layout = model.layout.joint(joint);
    let [least, largest] = layout.limits;
    let shown = selection
        .goal
        .unwrap_or_else(|| layout.clamp(state.position));
    let mut value = shown;
    ui.spacing_mut().slider_width = TRACK_WIDTH;
    let typed = TypedRange(least..=largest);
    let context = ui.ctx().clone();
    let slider = Slider::new(&mut value, least..=largest)
        .custom_formatter(|value, _| number(value, 3))
        .custom_parser(move |text| typed.take(&context, "Goal", text))
        .suffix(unit(layout))
        .update_while_editing(false);
    let slider = ui
        .add_enabled(model.is_free(joint), slider)
        .on_hover_text("Target of the joint")
        .on_disabled_hover_text(SCRIPT_MOVES);
    name(&slider, WidgetType::Slider, "Goal");
    // An object as wide as a gripper opens is released where the slider cannot go any farther.
    let is_wide_open = layout.is_gripper() && state.position >= largest && value >= largest;
    if value != shown || is_wide_open && is_confirmed(&slider) {
        selection.goal = Some(value);
        requests.push(Request::Go(joint, value));
    } else if state.velocity == 0.0 && !slider.is_pointer_button_down_on() {
        selection.goal = None;
    }
}

/// True if the user has just let go of a slider, or has finished its number with Enter.
fn is_confirmed(slider: &Response) -> bool {
    let has_entered = || slider.ctx.input(|input| input.key_pressed(Key::Enter));
    slider.drag_stopped() || slider.lost_focus() && has_entered()
}
