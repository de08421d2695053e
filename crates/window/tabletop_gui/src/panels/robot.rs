//! The Robot window (report sections 5 and 5.1, figure 9c): the robot's joints by hand, and its state.

mod joint;
mod model;
mod reading;
mod real;
mod state;
#[cfg(test)]
mod tests;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{CollapsingHeader, ComboBox, Ui, WidgetType},
};
use tabletop_core::{
    Actor, Agent, CommandWriter, Drive, Face, LimbId, ObjectSpec, Robot, RobotCommand, RobotLayout,
    ScriptCommand,
};
use tabletop_input::{Jog, toggled};
use tabletop_user::{Action, Connection, ConnectionOrder, HeadView, Keymap};

use self::{
    joint::{JointSelection, goal, joint},
    model::{Model, Request, RobotInput},
    real::{ConnectionDraft, real_robot},
    state::state,
};
use crate::{
    panels::{Panel, Panels},
    widgets::{button::switch, name::name},
};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_panel);
}

/// The resources from which the model is made.
#[derive(SystemParam)]
struct Sources<'w, 's> {
    robot: Res<'w, Robot>,
    layout: Res<'w, RobotLayout>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    agent: Res<'w, Agent>,
    keymap: Res<'w, Keymap>,
    connection: Res<'w, Connection>,
}

impl Sources<'_, '_> {
    /// Ids of the objects in the gripper of a limb.
    fn held_by(&self, limb: LimbId) -> Vec<&str> {
        let held = &self.robot.limb(limb).holds;
        self.specs.iter_many(held).map(|spec| &*spec.id).collect()
    }
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    sources: Sources,
    mut drafts: Local<RobotDrafts>,
    mut head_view: ResMut<HeadView>,
    mut jog: ResMut<Jog>,
    mut commands: CommandWriter,
    mut orders: MessageWriter<ScriptCommand>,
    mut connections: MessageWriter<ConnectionOrder>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let held: Vec<_> = (sources.layout.limb_ids())
        .map(|limb| sources.held_by(limb))
        .collect();
    let model = Model {
        robot: &sources.robot,
        layout: &sources.layout,
        held: &held,
        shows_head_view: head_view.is_shown(),
        is_scripted: sources.agent.is_on(),
        keymap: &sources.keymap,
        connection: &sources.connection,
    };
    let input = Panel::Robot.show(context, &mut panels, |ui| show(ui, &model, &mut drafts));
    let RobotInput { pressed, requests } = input.unwrap_or_default();
    jog.press_buttons(pressed.held, pressed.struck);
    for request in requests {
        match request {
            Request::ToggleHeadView => head_view.toggle(),
            Request::ToggleScript => {
                orders.write(toggled(&sources.agent));
            }
            Request::ShowRobot(is_shown) => {
                commands.write(Actor::Panel, RobotCommand::Show(is_shown));
            }
            Request::GoHome => {
                let joints = sources.layout.joints.iter();
                let home = joints.map(|joint| (joint.name, Drive::Toward(joint.home)));
                commands.write(Actor::Panel, RobotCommand::drive(home));
            }
            Request::Go(joint, goal) => {
                let drive = Drive::Toward(goal);
                let joint = sources.layout.joint(joint).name;
                commands.write(Actor::Panel, RobotCommand::drive([(joint, drive)]));
            }
            Request::ShowFace(face) => {
                commands.write(Actor::Panel, RobotCommand::ShowFace(face));
            }
            Request::Connection(order) => {
                connections.write(order);
            }
        }
    }
}

/// What the user has chosen and typed in the window.
#[derive(Default)]
struct RobotDrafts {
    selection: JointSelection,
    connection: ConnectionDraft,
}

fn show(ui: &mut Ui, model: &Model, drafts: &mut RobotDrafts) -> RobotInput {
    let RobotDrafts {
        selection,
        connection,
    } = drafts;
    let mut input = RobotInput::default();
    switches(ui, model, &mut input.requests);
    ui.separator();
    joint(ui, model, selection, &mut input);
    goal(ui, model, selection, &mut input.requests);
    ui.separator();
    if model.layout.screen.is_some() {
        face(ui, model, &mut input.requests);
    }
    CollapsingHeader::new("Joints and grippers").show(ui, |ui| state(ui, model, selection.joint));
    let order = real_robot(ui, model.connection, connection);
    input.requests.extend(order.map(Request::Connection));
    input
}

/// The switches: visible parts, and the control of the robot.
fn switches(ui: &mut Ui, model: &Model, requests: &mut Vec<Request>) {
    let is_shown = model.robot.is_shown;
    ui.horizontal(|ui| {
        for (text, is_on, action, request) in [
            (
                "Show/Hide",
                is_shown,
                Action::ShowRobot,
                Request::ShowRobot(!is_shown),
            ),
            (
                "Head View",
                model.shows_head_view,
                Action::ShowHeadView,
                Request::ToggleHeadView,
            ),
            (
                "Matlab Control",
                model.is_scripted,
                Action::RunScript,
                Request::ToggleScript,
            ),
        ] {
            if switch(ui, is_on, text, &model.keymap.tooltip(action)).clicked() {
                requests.push(request);
            }
        }
    });
}

fn face(ui: &mut Ui, model: &Model, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        ui.label("Face:");
        let before = model.robot.face;
        let mut face = before;
        let list = ComboBox::from_id_salt("face")
            .selected_text(format!("{face:?}"))
            .show_ui(ui, |ui| {
                for choice in Face::ALL {
                    ui.selectable_value(&mut face, choice, format!("{choice:?}"));
                }
            });
        name(&list.response, WidgetType::ComboBox, "Face");
        let tooltip = model.keymap.hint(Action::ShowNextFace);
        let tooltip = format!("What the robot's screen shows (next one: {tooltip})");
        list.response.on_hover_text(tooltip);
        if face != before {
            requests.push(Request::ShowFace(face));
        }
    });
}
