use bevy_egui::egui::{self, Event, Modifiers, PointerButton, accesskit::Role};
use egui_kittest::{Harness, kittest::Queryable as _};

use tabletop_core::{JointId, RobotJoint};

use super::{
    joint::TRACK_WIDTH,
    model::PressedButtons,
    reading::{number, reading},
    *,
};
use crate::panels::test_click::after_click;
use tabletop_input::Directions;

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

/// The content of the window in a test, and everything that was asked of it.
#[derive(Default)]
struct Stage {
    robot: Robot,
    is_scripted: bool,
    keymap: Keymap,
    drafts: RobotDrafts,
    pressed: PressedButtons,
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
                connection: &Connection::None,
            };
            let input = show(ui, &model, &mut stage.drafts);
            stage.requests.extend(input.requests);
            stage.pressed = input.pressed;
            stage.struck.push(of_first_joint(&stage.pressed.struck));
        };
        Harness::builder()
            .with_size(egui::vec2(Panel::Robot.width(), 600.0))
            .build_ui_state(frame, self)
    }

    fn after_click(self, name: &str) -> Vec<Request> {
        after_click(self.harness(), name).requests
    }
}

fn of_first_joint(directions: &Directions) -> i8 {
    let mut others = RobotLayout::baxter().joint_ids().skip(1);
    assert!(others.all(|joint| directions.get(joint) == 0));
    directions.get(JointId(0))
}

#[test]
fn each_switch_makes_its_request() {
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
        assert_eq!(harness.state().drafts.selection.joint, joint);
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
fn a_wide_open_gripper_is_commanded_to_open_by_its_slider() {
    let joint = JointId::from(RobotJoint::LeftGripper);
    let stage = || Stage {
        drafts: RobotDrafts {
            selection: JointSelection { joint, goal: None },
            ..default()
        },
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
fn objects_in_the_grippers_are_shown() {
    let mut harness = Stage::default().harness();
    assert!(harness.query_by_label("red, blue").is_none());
    harness.get_by_label("Joints and grippers").click();
    harness.run();
    assert!(harness.query_by_label("red, blue").is_some());
}
