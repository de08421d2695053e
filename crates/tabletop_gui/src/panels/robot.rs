//! The Robot window (report sections 5 and 5.1, figure 9c): the robot's joints by hand, and what is known of it.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Button, ComboBox, Label, RichText, Slider, Ui},
};
use tabletop_core::{
    Agent, AgentOrder, Arm, Drive, Face, ObjectSpec, Robot, RobotJoint, SimCommand,
};

use crate::{
    input::jog::{Directions, Jog},
    input::script_control::toggled,
    panels::head_view::HeadView,
    panels::{Panel, Panels},
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
    app.add_systems(EguiPrimaryContextPass, show_window);
}

/// The joint that the user has selected.
struct Selection {
    joint: RobotJoint,
    /// Where the user has sent it, while it is under way.
    goal: Option<f64>,
}

impl Default for Selection {
    fn default() -> Self {
        Self {
            joint: RobotJoint::LeftS0,
            goal: None,
        }
    }
}

/// What the window shows and changes.
#[derive(SystemParam)]
struct RobotWindow<'w, 's> {
    robot: Res<'w, Robot>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    head_view: ResMut<'w, HeadView>,
    jog: ResMut<'w, Jog>,
    selection: Local<'s, Selection>,
    commands: MessageWriter<'w, SimCommand>,
    agent: Res<'w, Agent>,
    orders: MessageWriter<'w, AgentOrder>,
}

fn show_window(mut contexts: EguiContexts, mut panels: ResMut<Panels>, mut window: RobotWindow) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let mut pressed = Pressed::default();
    Panel::Robot.show(context, &mut panels, |ui| {
        window.switches(ui);
        ui.separator();
        pressed = window.joint(ui);
        window.goal(ui);
        ui.separator();
        window.state(ui);
        ui.separator();
        window.face(ui);
    });
    window.jog.buttons.update(pressed.held, pressed.struck);
}

/// Where the buttons move the joints.
#[derive(Default)]
struct Pressed {
    /// Those that are held down.
    held: Directions,
    /// Those that have gone down in this frame.
    struck: Directions,
}

impl RobotWindow<'_, '_> {
    /// What there is to see, and who controls the robot.
    fn switches(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let is_shown = self.robot.is_shown;
            if switch(ui, "Show/Hide", is_shown) {
                self.commands.write(SimCommand::ShowRobot(!is_shown));
            }
            if switch(ui, "Head View", self.head_view.is_shown()) {
                self.head_view.toggle();
            }
            if switch(ui, "Matlab Control", self.agent.is_on()) {
                self.orders.write(toggled(&self.agent));
            }
        });
    }

    /// Whether the user can move the selected joint: a script moves the arms.
    fn is_free(&self) -> bool {
        !self.agent.is_on() || self.selection.joint == RobotJoint::HeadPan
    }

    /// Selects a joint, and moves it while a button is held down.
    fn joint(&mut self, ui: &mut Ui) -> Pressed {
        let mut pressed = Pressed::default();
        ui.horizontal(|ui| {
            let before = self.selection.joint;
            let mut joint = before;
            ComboBox::from_id_salt("joint")
                .selected_text(label(joint))
                .width(120.0)
                .height(LIST_HEIGHT)
                .show_ui(ui, |ui| {
                    for choice in RobotJoint::ALL {
                        ui.selectable_value(&mut joint, choice, label(choice));
                    }
                });
            if joint != before {
                *self.selection = Selection { joint, goal: None };
            }
            for (text, direction) in [("−", -1), ("+", 1)] {
                let button = Button::new(RichText::new(text).strong().monospace());
                let button = button.min_size(egui::vec2(32.0, 0.0));
                let response = ui.add_enabled(self.is_free(), button);
                let response = response.on_disabled_hover_text(SCRIPT_MOVES);
                let is_held = response.is_pointer_button_down_on();
                let has_gone_down = ui.input(|input| input.pointer.primary_pressed());
                let joint = joint.index();
                if is_held {
                    pressed.held[joint] = direction;
                }
                // A short click may be over within a frame.
                if has_gone_down && (is_held || response.clicked()) {
                    pressed.struck[joint] = direction;
                }
            }
            let home = ui.add_enabled(!self.agent.is_on(), Button::new("Home"));
            if home.on_disabled_hover_text(SCRIPT_MOVES).clicked() {
                let home = RobotJoint::ALL.map(|joint| (joint, Drive::Toward(joint.home())));
                self.commands.write(SimCommand::Drive(home.into()));
                self.selection.goal = None;
            }
        });
        pressed
    }

    /// Sends the selected joint somewhere.
    fn goal(&mut self, ui: &mut Ui) {
        let Selection { joint, goal } = *self.selection;
        let state = self.robot.joint(joint);
        let (least, largest) = joint.limits();
        let shown = goal.unwrap_or_else(|| joint.clamp(state.position));
        let mut value = shown;
        ui.spacing_mut().slider_width = TRACK_WIDTH;
        let slider = Slider::new(&mut value, least..=largest)
            .custom_formatter(|value, _| number(value, 3))
            .suffix(unit(joint))
            .update_while_editing(false);
        let slider = ui.add_enabled(self.is_free(), slider);
        let slider = slider.on_disabled_hover_text(SCRIPT_MOVES);
        if value != shown {
            self.selection.goal = Some(value);
            let drive = Drive::Toward(value);
            self.commands.write(SimCommand::Drive(vec![(joint, drive)]));
        } else if state.velocity == 0.0 && !slider.is_pointer_button_down_on() {
            self.selection.goal = None;
        }
    }

    /// The arms side by side.
    fn state(&self, ui: &mut Ui) {
        let grid = egui::Grid::new("state")
            .striped(true)
            .spacing(egui::vec2(12.0, 2.0))
            .max_col_width(ARM_WIDTH);
        grid.show(ui, |ui| {
            let row = |ui: &mut Ui, name: &str, cell: &dyn Fn(Arm) -> RichText| {
                ui.label(name);
                for arm in Arm::BOTH {
                    ui.add(Label::new(cell(arm)).truncate());
                }
                ui.end_row();
            };
            row(ui, "rad, °", &|arm| match arm {
                Arm::Left => RichText::new("Left").strong(),
                Arm::Right => RichText::new("Right").strong(),
            });
            for (i, joint) in RobotJoint::of_arm(Arm::Left).into_iter().enumerate() {
                let name = label(joint).trim_start_matches("Left ");
                row(ui, name, &|arm| self.value(RobotJoint::of_arm(arm)[i]));
            }
            row(ui, "Gripper", &|arm| self.value(RobotJoint::gripper(arm)));
            row(ui, "Holds", &|arm| self.held_by(arm).into());
            row(ui, "Blocked", &|arm| {
                let blocked_by = self.robot.arm(arm).blocked_by.as_deref();
                blocked_by.unwrap_or(NOTHING).into()
            });
            ui.label("Head H0");
            ui.label(self.value(RobotJoint::HeadPan));
            ui.end_row();
        });
    }

    /// Where a joint stands; the selected one stands out.
    fn value(&self, joint: RobotJoint) -> RichText {
        let position = self.robot.joint(joint).position;
        let text = RichText::new(reading(joint, position)).monospace();
        if joint == self.selection.joint {
            text.strong()
        } else {
            text
        }
    }

    /// Ids of what the gripper of an arm holds.
    fn held_by(&self, arm: Arm) -> String {
        let held = &self.robot.arm(arm).holds;
        let ids: Vec<_> = self.specs.iter_many(held).map(|spec| &*spec.id).collect();
        if ids.is_empty() {
            NOTHING.into()
        } else {
            ids.join(", ")
        }
    }

    fn face(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label("Face:");
            let before = self.robot.face;
            let mut face = before;
            ComboBox::from_id_salt("face")
                .selected_text(format!("{face:?}"))
                .show_ui(ui, |ui| {
                    for choice in Face::ALL {
                        ui.selectable_value(&mut face, choice, format!("{choice:?}"));
                    }
                });
            if face != before {
                self.commands.write(SimCommand::ShowFace(face));
            }
        });
    }
}

const NOTHING: &str = "-";

/// A button that shows whether something is on; whether it was clicked.
fn switch(ui: &mut Ui, text: &str, is_on: bool) -> bool {
    ui.add(Button::new(text).selected(is_on)).clicked()
}

/// Name of a joint, as in the report's figure 10.
const fn label(joint: RobotJoint) -> &'static str {
    const LABELS: [&str; RobotJoint::ALL.len()] = [
        "Left S0",
        "Left S1",
        "Left E0",
        "Left E1",
        "Left W0",
        "Left W1",
        "Left W2",
        "Right S0",
        "Right S1",
        "Right E0",
        "Right E1",
        "Right W0",
        "Right W1",
        "Right W2",
        "Head H0",
        "Left gripper",
        "Right gripper",
    ];
    LABELS[joint.index()]
}

/// What a joint's position is measured in.
const fn unit(joint: RobotJoint) -> &'static str {
    if joint.is_gripper() { "" } else { " rad" }
}

/// Where a joint stands: an angle in rad and degrees, an opening in units.
fn reading(joint: RobotJoint, position: f64) -> String {
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
    use super::*;
    use bevy_egui::egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, vec2};

    #[test]
    fn joints_are_labelled_by_arm_and_name() {
        for joint in RobotJoint::ALL {
            let label = label(joint).to_lowercase().replace(' ', "_");
            let expected = match joint {
                RobotJoint::HeadPan => "head_h0",
                _ => joint.name(),
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
            assert_eq!(reading(joint, position), expected);
        }
        assert_eq!(number(-0.001, 3), "-0.001");
    }

    /// An app with nothing but the window's content in an egui of its own.
    struct Bench {
        world: World,
        context: egui::Context,
    }

    impl Bench {
        fn new() -> Self {
            let mut world = World::new();
            world.init_resource::<Robot>();
            world.init_resource::<HeadView>();
            world.init_resource::<Jog>();
            world.init_resource::<Messages<SimCommand>>();
            world.init_resource::<Agent>();
            world.init_resource::<Messages<AgentOrder>>();
            Self {
                world,
                context: egui::Context::default(),
            }
        }

        /// A frame with these events: the buttons' directions, and the commands.
        fn frame(&mut self, events: Vec<Event>) -> (Pressed, Vec<SimCommand>) {
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0))),
                events,
                ..RawInput::default()
            };
            let mut pressed = Pressed::default();
            let mut state = bevy::ecs::system::SystemState::<RobotWindow>::new(&mut self.world);
            let mut window = state.get_mut(&mut self.world).unwrap();
            let _output = self.context.run_ui(input, |ui| {
                pressed = window.joint(ui);
                window.goal(ui);
            });
            let mut messages = self.world.resource_mut::<Messages<SimCommand>>();
            (pressed, messages.drain().collect())
        }

        fn button(&self, at: Pos2, pressed: bool) -> Event {
            Event::PointerButton {
                pos: at,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::default(),
            }
        }
    }

    fn of_first_joint(directions: Directions) -> i8 {
        assert!(directions[1..].iter().all(|&direction| direction == 0));
        directions[0]
    }

    #[test]
    fn the_buttons_move_the_selected_joint_while_they_are_held() {
        let mut hits = Vec::new();
        for x in (4..400).step_by(8) {
            let at = Pos2::new(x as f32, 10.0);
            let mut bench = Bench::new();
            bench.frame(vec![]);
            bench.frame(vec![Event::PointerMoved(at)]);
            let (down, _) = bench.frame(vec![bench.button(at, true)]);
            let direction = of_first_joint(down.held);
            assert_eq!(of_first_joint(down.struck), direction);
            let (held, _) = bench.frame(vec![]);
            assert_eq!(of_first_joint(held.held), direction);
            assert_eq!(of_first_joint(held.struck), 0);
            let (up, commands) = bench.frame(vec![bench.button(at, false)]);
            assert_eq!([up.held, up.struck].map(of_first_joint), [0, 0]);
            hits.push((direction, commands.len()));
        }
        hits.dedup();
        hits.retain(|&hit| hit != (0, 0));
        // Left to right: minus, plus, Home.
        assert_eq!(hits, [(-1, 0), (1, 0), (0, 1)]);
    }

    #[test]
    fn a_click_within_a_frame_strikes() {
        let mut strikes = Vec::new();
        for x in (4..400).step_by(8) {
            let at = Pos2::new(x as f32, 10.0);
            let mut bench = Bench::new();
            bench.frame(vec![]);
            bench.frame(vec![Event::PointerMoved(at)]);
            let (click, _) = bench.frame(vec![bench.button(at, true), bench.button(at, false)]);
            strikes.push(of_first_joint(click.struck));
        }
        strikes.dedup();
        strikes.retain(|&strike| strike != 0);
        assert_eq!(strikes, [-1, 1]);
    }

    #[test]
    fn the_slider_sends_the_joint_where_it_is_clicked_and_nothing_otherwise() {
        let mut bench = Bench::new();
        assert_eq!(bench.frame(vec![]).1, []);
        let at = Pos2::new(100.0, 32.0);
        bench.frame(vec![Event::PointerMoved(at)]);
        let (_, commands) = bench.frame(vec![bench.button(at, true)]);
        let [SimCommand::Drive(drives)] = &commands[..] else {
            panic!("{commands:?}");
        };
        let [(RobotJoint::LeftS0, Drive::Toward(goal))] = drives[..] else {
            panic!("{drives:?}");
        };
        assert!((-0.2..0.2).contains(&goal), "{goal}");
    }
}
