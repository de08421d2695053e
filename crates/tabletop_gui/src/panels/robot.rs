//! The Robot window (report sections 5 and 5.1, figure 9c): the robot's joints by hand, and what is known of it.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        self, Button, CollapsingHeader, ComboBox, Key, Label, Response, RichText, Slider, Ui,
        WidgetInfo, WidgetType,
    },
};
use tabletop_core::{
    Action, Actor, Agent, CommandWriter, Drive, Face, JointId, JointLayout, Keymap, LimbId,
    ObjectSpec, Robot, RobotCommand, RobotLayout, ScriptCommand, Way,
};

use crate::{
    input::{
        jog::{Directions, Jog},
        script_control::toggled,
    },
    panels::{Panel, Panels, head_view::HeadView},
    widgets::button::{hold_button, switch},
};

/// Width of the track of the slider, in points.
const TRACK_WIDTH: f32 = 196.0;

/// Width of the table's columns for the arms, in points.
const ARM_WIDTH: f32 = 112.0;

/// Why joints cannot be moved by hand.
const SCRIPT_MOVES: &str = "a script moves the arms";

/// So high that the list of joints needs no scroll bar, in points.
const LIST_HEIGHT: f32 = 400.0;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_panel);
}

/// The joint that the user has selected.
struct Selection {
    joint: JointId,
    /// Where the user has sent it, while it is under way.
    goal: Option<f64>,
}

impl Default for Selection {
    fn default() -> Self {
        Self {
            joint: JointId(0),
            goal: None,
        }
    }
}

/// What the window shows.
#[derive(Clone, Copy)]
struct Model<'a> {
    robot: &'a Robot,
    layout: &'a RobotLayout,
    /// Ids of what the grippers hold, by limb.
    held: &'a [Vec<&'a str>],
    shows_head_view: bool,
    /// Whether a script moves the arms.
    is_scripted: bool,
    keymap: &'a Keymap,
}

impl Model<'_> {
    /// Whether the user can move a joint.
    fn is_free(&self, joint: JointId) -> bool {
        !self.is_scripted || self.layout.neck == Some(joint)
    }
}

/// What the user does with the window.
#[derive(Default)]
struct Asked {
    pressed: Pressed,
    requests: Vec<Request>,
}

/// Where the buttons move the joints.
#[derive(Default)]
struct Pressed {
    /// Those that are held down.
    held: Directions,
    /// Those that have gone down in this frame.
    struck: Directions,
}

/// What the user asks of the window once.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Request {
    ShowRobot(bool),
    ToggleHeadView,
    ToggleScript,
    /// Bring all joints back to where they stood at the start.
    GoHome,
    /// Bring a joint to an angle in rad, or an opening in units.
    Go(JointId, f64),
    ShowFace(Face),
}

/// Where the model comes from.
#[derive(SystemParam)]
struct Sources<'w, 's> {
    robot: Res<'w, Robot>,
    layout: Res<'w, RobotLayout>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    agent: Res<'w, Agent>,
    keymap: Res<'w, Keymap>,
}

impl Sources<'_, '_> {
    /// Ids of what the gripper of a limb holds.
    fn held_by(&self, limb: LimbId) -> Vec<&str> {
        let held = &self.robot.limb(limb).holds;
        self.specs.iter_many(held).map(|spec| &*spec.id).collect()
    }
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    sources: Sources,
    mut selection: Local<Selection>,
    mut head_view: ResMut<HeadView>,
    mut jog: ResMut<Jog>,
    mut commands: CommandWriter,
    mut orders: MessageWriter<ScriptCommand>,
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
    };
    let asked = Panel::Robot.show(context, &mut panels, |ui| show(ui, &model, &mut selection));
    let Asked { pressed, requests } = asked.unwrap_or_default();
    jog.buttons.update(pressed.held, pressed.struck);
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
        }
    }
}

fn show(ui: &mut Ui, model: &Model, selection: &mut Selection) -> Asked {
    let mut asked = Asked::default();
    switches(ui, model, &mut asked.requests);
    ui.separator();
    joint(ui, model, selection, &mut asked);
    goal(ui, model, selection, &mut asked.requests);
    ui.separator();
    if model.layout.screen.is_some() {
        face(ui, model, &mut asked.requests);
    }
    CollapsingHeader::new("Joints and grippers").show(ui, |ui| state(ui, model, selection.joint));
    asked
}

/// What there is to see, and who controls the robot.
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

/// Selects a joint, and moves it while a button is held down.
fn joint(ui: &mut Ui, model: &Model, selection: &mut Selection, asked: &mut Asked) {
    ui.horizontal(|ui| {
        let joint = chosen_joint(ui, model.layout, selection.joint);
        if joint != selection.joint {
            *selection = Selection { joint, goal: None };
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
                asked.pressed.held.set(joint, direction);
            }
            if button.was_struck {
                asked.pressed.struck.set(joint, direction);
            }
        }
        let home = "Bring every joint back to where it stood at the start";
        let home = ui
            .add_enabled(!model.is_scripted, Button::new("Home"))
            .on_hover_text(home)
            .on_disabled_hover_text(SCRIPT_MOVES);
        if home.clicked() {
            asked.requests.push(Request::GoHome);
            selection.goal = None;
        }
    });
}

/// What a button does, and the keys that do it.
fn tooltip(model: &Model, joint: JointId, way: Way) -> String {
    match Action::moving(model.layout.joint(joint), way) {
        Some(action) => model.keymap.tooltip(action),
        None => "Moves the joint".to_owned(),
    }
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
fn goal(ui: &mut Ui, model: &Model, selection: &mut Selection, requests: &mut Vec<Request>) {
    let joint = selection.joint;
    let state = model.robot.joint(joint);
    let layout = model.layout.joint(joint);
    let [least, largest] = layout.limits;
    let shown = selection
        .goal
        .unwrap_or_else(|| layout.clamp(state.position));
    let mut value = shown;
    ui.spacing_mut().slider_width = TRACK_WIDTH;
    let slider = Slider::new(&mut value, least..=largest)
        .custom_formatter(|value, _| number(value, 3))
        .suffix(unit(layout))
        .update_while_editing(false);
    let slider = ui
        .add_enabled(model.is_free(joint), slider)
        .on_hover_text("Where the joint is to go")
        .on_disabled_hover_text(SCRIPT_MOVES);
    name(&slider, WidgetType::Slider, "Goal");
    // What is as wide as a gripper opens is released where the slider cannot go any farther.
    let is_wide_open = layout.is_gripper() && state.position >= largest && value >= largest;
    if value != shown || is_wide_open && is_confirmed(&slider) {
        selection.goal = Some(value);
        requests.push(Request::Go(joint, value));
    } else if state.velocity == 0.0 && !slider.is_pointer_button_down_on() {
        selection.goal = None;
    }
}

/// Whether the user has just let go of a slider, or has finished its number with Enter.
fn is_confirmed(slider: &Response) -> bool {
    let has_entered = || slider.ctx.input(|input| input.key_pressed(Key::Enter));
    slider.drag_stopped() || slider.lost_focus() && has_entered()
}

/// The arms side by side.
fn state(ui: &mut Ui, model: &Model, selected: JointId) {
    let layout = model.layout;
    let value = |joint: JointId| {
        let position = model.robot.joint(joint).position;
        let text = RichText::new(reading(layout.joint(joint), position)).monospace();
        if joint == selected {
            text.strong()
        } else {
            text
        }
    };
    let grid = egui::Grid::new("state")
        .striped(true)
        .spacing(egui::vec2(12.0, 2.0))
        .max_col_width(ARM_WIDTH);
    grid.show(ui, |ui| {
        let row = |ui: &mut Ui, name: &str, cell: &dyn Fn(LimbId) -> RichText| {
            ui.label(name);
            for limb in layout.limb_ids() {
                ui.add(Label::new(cell(limb)).truncate());
            }
            ui.end_row();
        };
        row(ui, "rad, °", &|limb| {
            RichText::new(&layout.limb(limb).label).strong()
        });
        for i in 0..layout.most_joints_of_a_limb() {
            let named = layout.limbs.iter().find_map(|limb| limb.joints.get(i));
            let name = named.map_or("", |joint| &layout.joint(*joint).label);
            row(ui, name, &|limb| match layout.limb(limb).joints.get(i) {
                Some(joint) => value(*joint),
                None => NOTHING.into(),
            });
        }
        row(ui, "Gripper", &|limb| {
            value(layout.limb(limb).gripper.joint)
        });
        row(ui, "Holds", &|limb| held(model, limb).into());
        row(ui, "Blocked", &|limb| {
            let blocked_by = model.robot.limb(limb).blocked_by.as_deref();
            blocked_by.unwrap_or(NOTHING).into()
        });
        if let Some(neck) = layout.neck {
            ui.label(layout.label_of(neck));
            ui.label(value(neck));
            ui.end_row();
        }
    });
}

fn held(model: &Model, limb: LimbId) -> String {
    match &*model.held[limb.index()] {
        [] => NOTHING.into(),
        ids => ids.join(", "),
    }
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

/// Gives a widget without words a name.
fn name(response: &egui::Response, kind: WidgetType, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(kind, response.enabled(), name));
}

const NOTHING: &str = "-";

/// What a joint's position is measured in.
const fn unit(joint: &JointLayout) -> &'static str {
    if joint.is_gripper() { "" } else { " rad" }
}

/// Where a joint stands: an angle in rad and degrees, an opening in units.
fn reading(joint: &JointLayout, position: f64) -> String {
    let value = number(position, 3);
    if joint.is_gripper() {
        format!("{value:>6}")
    } else {
        format!("{value:>6} {:>6}°", number(position.to_degrees(), 1))
    }
}

/// A number with so many decimals; no zero has a sign.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|c| matches!(c, '0' | '.')) => zero.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Event, Modifiers, PointerButton, accesskit::Role};
    use egui_kittest::{Harness, kittest::Queryable as _};

    use tabletop_core::RobotJoint;

    use super::*;

    #[test]
    fn joints_are_labelled_by_arm_and_name() {
        let baxter = RobotLayout::baxter();
        for id in baxter.joint_ids() {
            let label = baxter.label_of(id).to_lowercase().replace(' ', "_");
            let expected = match baxter.joint(id).name.as_str() {
                "head_pan" => "head_h0",
                name => name,
            };
            assert_eq!(label, expected);
        }
    }

    #[test]
    fn angles_are_read_in_rad_and_degrees_openings_in_units() {
        for (joint, position, expected) in [
            (RobotJoint::LeftE1, 2.618, " 2.618  150.0°"),
            (RobotJoint::RightS1, -2.147, "-2.147 -123.0°"),
            (RobotJoint::HeadPan, -0.0001, " 0.000    0.0°"),
            (RobotJoint::LeftGripper, 1.5, " 1.500"),
        ] {
            assert_eq!(reading(joint.layout(), position), expected);
        }
        assert_eq!(number(-0.001, 3), "-0.001");
    }

    /// What the window is shown with, and everything that was asked of it.
    #[derive(Default)]
    struct Stage {
        robot: Robot,
        is_scripted: bool,
        keymap: Keymap,
        selection: Selection,
        pressed: Pressed,
        struck: Vec<i8>,
        requests: Vec<Request>,
    }

    impl Stage {
        fn scripted() -> Self {
            Self {
                is_scripted: true,
                ..default()
            }
        }

        fn harness(self) -> Harness<'static, Self> {
            let frame = |ui: &mut Ui, stage: &mut Self| {
                let model = Model {
                    robot: &stage.robot,
                    layout: RobotLayout::baxter(),
                    held: &[vec![], vec!["red", "blue"]],
                    shows_head_view: false,
                    is_scripted: stage.is_scripted,
                    keymap: &stage.keymap,
                };
                let asked = show(ui, &model, &mut stage.selection);
                stage.requests.extend(asked.requests);
                stage.pressed = asked.pressed;
                stage.struck.push(of_first_joint(&stage.pressed.struck));
            };
            Harness::builder()
                .with_size(egui::vec2(Panel::Robot.width(), 600.0))
                .build_ui_state(frame, self)
        }

        fn after_click(self, name: &str) -> Vec<Request> {
            let mut harness = self.harness();
            harness.get_by_label(name).click();
            harness.run();
            harness.into_state().requests
        }
    }

    fn of_first_joint(directions: &Directions) -> i8 {
        let mut others = RobotLayout::baxter().joint_ids().skip(1);
        assert!(others.all(|joint| directions.get(joint) == 0));
        directions.get(JointId(0))
    }

    #[test]
    fn the_switches_ask_for_what_they_say() {
        for (name, request) in [
            ("Show/Hide", Request::ShowRobot(true)),
            ("Head View", Request::ToggleHeadView),
            ("Matlab Control", Request::ToggleScript),
            ("Home", Request::GoHome),
        ] {
            assert_eq!(Stage::default().after_click(name), [request]);
        }
    }

    #[test]
    fn a_robot_that_is_shown_can_be_hidden() {
        let mut stage = Stage::default();
        stage.robot.is_shown = true;
        let requests = stage.after_click("Show/Hide");
        assert_eq!(requests, [Request::ShowRobot(false)]);
    }

    #[test]
    fn the_buttons_move_the_selected_joint_while_they_are_held() {
        for (name, direction) in [("−", -1), ("+", 1)] {
            let mut harness = Stage::default().harness();
            let at = harness.get_by_label(name).rect().center();
            let held = |harness: &Harness<Stage>| of_first_joint(&harness.state().pressed.held);
            harness.hover_at(at);
            harness.drag_at(at);
            harness.run();
            harness.run();
            assert_eq!(held(&harness), direction);
            harness.drop_at(at);
            harness.run();
            assert_eq!(held(&harness), 0);
            let struck = harness.state().struck.iter();
            let struck: Vec<_> = struck.filter(|&&struck| struck != 0).collect();
            assert_eq!(struck, [&direction], "struck once");
        }
    }

    #[test]
    fn a_click_within_a_frame_strikes() {
        for (name, direction) in [("−", -1), ("+", 1)] {
            let mut harness = Stage::default().harness();
            let pos = harness.get_by_label(name).rect().center();
            harness.hover_at(pos);
            harness.run();
            for pressed in [true, false] {
                harness.input_mut().events.push(Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed,
                    modifiers: Modifiers::default(),
                });
            }
            harness.run();
            assert!(harness.state().struck.contains(&direction), "{name}");
        }
    }

    #[test]
    fn every_joint_can_be_selected() {
        let baxter = RobotLayout::baxter();
        for joint in baxter.joint_ids() {
            let mut harness = Stage::default().harness();
            harness.get_by_label("Joint").click();
            harness.run();
            let label = baxter.label_of(joint);
            let choices = harness.query_all_by_label(&label);
            choices.last().unwrap().click();
            harness.run();
            assert_eq!(harness.state().selection.joint, joint);
            assert_eq!(harness.state().requests, []);
        }
    }

    #[test]
    fn every_face_can_be_chosen() {
        for face in Face::ALL {
            let mut stage = Stage::default();
            let other = Face::ALL.into_iter().find(|&other| other != face);
            stage.robot.face = other.unwrap();
            let mut harness = stage.harness();
            harness
                .get_by_role_and_label(Role::ComboBox, "Face")
                .click();
            harness.run();
            harness.get_by_label(&format!("{face:?}")).click();
            harness.run();
            assert_eq!(harness.state().requests, [Request::ShowFace(face)]);
        }
    }

    #[test]
    fn the_slider_sends_the_joint_where_it_is_clicked_and_nothing_otherwise() {
        let mut harness = Stage::default().harness();
        assert_eq!(harness.state().requests, []);
        let slider = harness.get_by_label("Goal").rect();
        let at = slider.min + egui::vec2(TRACK_WIDTH / 2.0, slider.height() / 2.0);
        harness.hover_at(at);
        harness.drag_at(at);
        harness.run();
        let [Request::Go(JointId(0), goal)] = harness.state().requests[..] else {
            panic!("{:?}", harness.state().requests);
        };
        assert!((-0.2..0.2).contains(&goal), "{goal}");
    }

    #[test]
    fn a_wide_open_gripper_is_told_to_open_by_its_slider() {
        let joint = JointId::from(RobotJoint::LeftGripper);
        let stage = || Stage {
            selection: Selection { joint, goal: None },
            ..default()
        };
        let mut harness = stage().harness();
        let slider = harness.get_by_label("Goal").rect();
        let end = slider.min + egui::vec2(TRACK_WIDTH - 2.0, slider.height() / 2.0);
        harness.hover_at(end);
        harness.drag_at(end);
        harness.run();
        harness.drop_at(end);
        harness.run();
        let widest = Request::Go(joint, 2.0);
        assert_eq!(harness.state().requests, [widest]);

        let mut harness = stage().harness();
        harness.hover_at(end);
        harness.run();
        assert_eq!(harness.state().requests, []);
    }

    #[test]
    fn while_a_script_moves_the_arms_the_user_cannot() {
        for name in ["Home", "−", "+", "Goal"] {
            let mut harness = Stage::scripted().harness();
            harness.get_by_label(name).click();
            harness.run();
            let stage = harness.state();
            assert_eq!(stage.requests, [], "{name}");
            assert!(stage.struck.iter().all(|&struck| struck == 0), "{name}");
        }
    }

    #[test]
    fn what_the_grippers_hold_is_shown() {
        let mut harness = Stage::default().harness();
        assert!(harness.query_by_label("red, blue").is_none());
        harness.get_by_label("Joints and grippers").click();
        harness.run();
        assert!(harness.query_by_label("red, blue").is_some());
    }
}
