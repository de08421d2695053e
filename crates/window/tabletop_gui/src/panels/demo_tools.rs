//! The Demonstration Tools (report section 4, figure 8): hands, held object, rotations, recording.

mod take;
#[cfg(test)]
mod tests;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Color32, Ui},
};
use tabletop_core::{
    Actor, CommandWriter, Hand, HandCommand, HandFact, Hands, History, HistoryCommand, ObjectSpec,
    Recording, RecordingCommand, Replaying, SimCommand, SimFact,
};
use tabletop_input::{PlaneButtons, TurnSums};
use tabletop_user::{Action, Keymap, NextTake};

use crate::{
    panels::{Panel, Panels},
    widgets::{
        button::{button, hold_button},
        slider::angle_slider,
    },
};

/// The sliders have the colours of the axes, a little lighter, for a dark panel.
const SLIDERS: [(&str, Color32); 3] = [
    ("X", Color32::from_rgb(255, 70, 70)),
    ("Y", Color32::from_rgb(60, 220, 60)),
    ("Z", Color32::from_rgb(90, 130, 255)),
];

/// The content of an empty hand (report figure 8b).
const EMPTY: &str = "<empty>";

/// The reason why the plane cannot be turned.
const NOTHING_HELD: &str = "the selected hand holds nothing";

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins(take::plugin)
        .add_systems(Update, open_at_first_grasp)
        .add_systems(EguiPrimaryContextPass, show_panel);
}

fn open_at_first_grasp(
    mut is_done: Local<bool>,
    mut facts: MessageReader<SimFact>,
    replaying: Res<Replaying>,
    mut panels: ResMut<Panels>,
) {
    let is_grasp = |fact: &SimFact| matches!(fact, SimFact::Hand(HandFact::Grasped { .. }));
    let has_grasped = facts.read().filter(|fact| is_grasp(fact)).count() > 0;
    if has_grasped && !replaying.0 && !*is_done {
        panels.set_open(Panel::DemonstrationTools, true);
        *is_done = true;
    }
}

/// The content of the panel.
#[derive(Clone, Copy, Debug)]
struct Model<'a> {
    /// The selected hand.
    hand: Hand,
    /// Id of the held object.
    held: Option<&'a str>,
    /// The turns about each axis, in degrees.
    turns: [i32; 3],
    is_recording: bool,
    history: History,
    keymap: &'a Keymap,
}

/// The user's input to the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ToolsInput {
    /// The buttons that are held down.
    plane: PlaneButtons,
    request: Option<Request>,
}

/// A wish of the user to the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Request {
    Select(Hand),
    Release,
    Destroy,
    /// Turn the held object about an axis until the sum of its turns is this.
    TurnTo {
        axis: usize,
        degrees: i32,
    },
    Start,
    Finish,
    Undo,
    Redo,
}

/// The resources from which the model is made.
#[derive(SystemParam)]
struct Sources<'w, 's> {
    hands: Res<'w, Hands>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    recording: Res<'w, Recording>,
    history: Res<'w, History>,
    keymap: Res<'w, Keymap>,
}

impl Sources<'_, '_> {
    fn model(&self, turns: &TurnSums) -> Model<'_> {
        let hand = self.hands.selected;
        let held = self.hands.held_by(hand);
        let held = held.and_then(|object| self.specs.get(object).ok());
        Model {
            hand,
            held: held.map(|spec| spec.id.as_str()),
            turns: turns.of(hand),
            is_recording: self.recording.0,
            history: *self.history,
            keymap: &self.keymap,
        }
    }
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    sources: Sources,
    mut turns: ResMut<TurnSums>,
    mut plane_buttons: ResMut<PlaneButtons>,
    mut take: ResMut<NextTake>,
    mut commands: CommandWriter,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let model = sources.model(&turns);
    let hand = model.hand;
    let mut edited = take.clone();
    let input =
        Panel::DemonstrationTools.show(context, &mut panels, |ui| show(ui, &model, &mut edited));
    take.set_if_neq(edited);
    let ToolsInput { plane, request } = input.unwrap_or_default();
    plane_buttons.set_if_neq(plane);
    if let Some(request) = request {
        commands.write_batch(Actor::Panel, command(request, hand, &mut turns));
    }
}

/// The command for a request to the panel while a hand is selected.
fn command(request: Request, hand: Hand, turns: &mut TurnSums) -> Option<SimCommand> {
    Some(match request {
        Request::Select(hand) => SimCommand::Hand(HandCommand::Select(hand)),
        Request::Release => SimCommand::Hand(HandCommand::Release(hand)),
        Request::Destroy => SimCommand::Hand(HandCommand::Destroy(hand)),
        Request::TurnTo { axis, degrees } => {
            return turns.turn_to(hand, axis, degrees).map(SimCommand::from);
        }
        Request::Start => SimCommand::Recording(RecordingCommand::Start),
        Request::Finish => SimCommand::Recording(RecordingCommand::Finish),
        Request::Undo => SimCommand::History(HistoryCommand::Undo),
        Request::Redo => SimCommand::History(HistoryCommand::Redo),
    })
}

fn show(ui: &mut Ui, model: &Model, take: &mut NextTake) -> ToolsInput {
    let hand = hands(ui, model);
    ui.separator();
    let object = held_object(ui, model);
    ui.separator();
    let is_holding = model.held.is_some();
    let rotation = |ui: &mut Ui| {
        let plane = plane_rotation(ui, model);
        ui.separator();
        (plane, object_rotation(ui, model))
    };
    let (plane, turn) = ui.add_enabled_ui(is_holding, rotation).inner;
    ui.separator();
    take::show(ui, take, model.is_recording);
    let recording = recording(ui, model);
    ToolsInput {
        plane,
        request: hand.or(object).or(turn).or(recording),
    }
}

fn hands(ui: &mut Ui, model: &Model) -> Option<Request> {
    let choose = |ui: &mut Ui| {
        ui.label("Current Hand:");
        let mut chosen = None;
        for hand in Hand::ALL {
            let is_selected = model.hand == hand;
            let radio = ui.radio(is_selected, format!("{hand:?}"));
            let radio = radio.on_hover_text(tooltip_of_hand(hand));
            if radio.clicked() && !is_selected {
                chosen = Some(Request::Select(hand));
            }
        }
        chosen
    };
    ui.horizontal(choose).inner
}

const fn tooltip_of_hand(hand: Hand) -> &'static str {
    match hand {
        Hand::Left => "Act with the left hand",
        Hand::Right => "Act with the right hand",
        Hand::Both => "Act with both hands at once",
        Hand::Any => "Act with whichever hand is free",
    }
}

fn held_object(ui: &mut Ui, model: &Model) -> Option<Request> {
    let is_holding = model.held.is_some();
    // A line for itself, so that a long id is seen.
    ui.horizontal_wrapped(|ui| {
        ui.label("Current Object:");
        ui.strong(model.held.unwrap_or(EMPTY));
    });
    let buttons = |ui: &mut Ui| {
        let release = button(ui, is_holding, "Release", "Let go of the object").clicked();
        let destroy = "Remove the object from the world";
        let destroy = button(ui, is_holding, "Destroy", destroy).clicked();
        match (release, destroy) {
            (true, _) => Some(Request::Release),
            (false, true) => Some(Request::Destroy),
            (false, false) => None,
        }
    };
    ui.horizontal(buttons).inner
}

/// The buttons that turn the plane while they are held down.
fn plane_rotation(ui: &mut Ui, model: &Model) -> PlaneButtons {
    let buttons = |ui: &mut Ui| {
        ui.label("Plane Rotation:");
        let mut is_down = |text, action| {
            let tooltip = model.keymap.tooltip(action);
            hold_button(ui, model.held.is_some(), text, &tooltip, NOTHING_HELD).is_held
        };
        PlaneButtons {
            counter_clockwise: is_down("CCW", Action::PlaneCounterClockwise),
            clockwise: is_down("CW", Action::PlaneClockwise),
        }
    };
    ui.horizontal(buttons).inner
}

fn object_rotation(ui: &mut Ui, model: &Model) -> Option<Request> {
    ui.label("Object Rotation:");
    let mut turn = None;
    for (axis, (name, color)) in SLIDERS.into_iter().enumerate() {
        let shown = model.turns[axis];
        let degrees = angle_slider(ui, name, color, shown);
        if degrees != shown {
            turn = Some(Request::TurnTo { axis, degrees });
        }
    }
    turn
}

fn recording(ui: &mut Ui, model: &Model) -> Option<Request> {
    let is_recording = model.is_recording;
    let can_undo = is_recording && model.history.undoable > 0;
    let can_redo = is_recording && model.history.redoable > 0;
    let [record, undo] = [Action::Record, Action::Undo].map(|it| model.keymap.tooltip(it));
    let redo = model.keymap.tooltip(Action::Redo);
    let buttons = |ui: &mut Ui| {
        ui.label("Recording:");
        let mut asked = None;
        for (request, is_enabled, text, tooltip) in [
            (Request::Start, !is_recording, "Start", &record),
            (Request::Finish, is_recording, "Finish", &record),
            (Request::Undo, can_undo, "Undo", &undo),
            (Request::Redo, can_redo, "Redo", &redo),
        ] {
            if button(ui, is_enabled, text, tooltip).clicked() {
                asked = Some(request);
            }
        }
        asked
    };
    ui.horizontal(buttons).inner
}
