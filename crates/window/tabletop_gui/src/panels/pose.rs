//! The Pose window: where the held object is, to read and to type, and how the mouse drags.

use std::ops::RangeInclusive;

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, DragValue, RichText, Ui},
};
use tabletop_core::{Actor, CommandWriter, HandCommand, Hands, Paused};
use tabletop_geometry::{Pose, quat_from_degrees};
use tabletop_input::{Regard, Regarded};
use tabletop_user::{Action, Dragging, Keymap, Measuring};

use crate::{
    kept::{Kept, keep},
    panels::{Panel, Panels},
    widgets::{button::switch, number::number_field},
};

/// Steps of numbers for a pixel, in units and degrees.
const UNITS_A_PIXEL: f32 = 0.02;
const DEGREES_A_PIXEL: f32 = 0.5;

/// Farthest place, in units, that can be typed.
const FARTHEST: f32 = 200.0;

const NOTHING: &str = "<nothing>";

impl Kept for Dragging {
    const CONCERN: &'static str = "dragging";
}

pub(crate) fn plugin(app: &mut App) {
    keep::<Dragging>(app);
    app.add_systems(EguiPrimaryContextPass, show_panel);
}

/// The content of the window.
struct Model<'a> {
    object: Option<Regarded<'a>>,
    /// True if the object is in the selected hand, and the hand can move it.
    is_movable: bool,
    dragging: Dragging,
    measuring: &'a Measuring,
    keymap: &'a Keymap,
}

/// A wish of the user to the window.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Request {
    /// Move the held object there, in units.
    MoveTo(Vec3),
    /// Turn it until its angles are these, in degrees.
    TurnTo(Vec3),
    Drag(Dragging),
    /// Begin or end to measure.
    Measure,
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    regard: Regard,
    hands: Res<Hands>,
    paused: Res<Paused>,
    keymap: Res<Keymap>,
    mut dragging: ResMut<Dragging>,
    mut measuring: ResMut<Measuring>,
    mut commands: CommandWriter,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    if !panels.is_open(Panel::Pose) {
        return;
    }
    let hand = hands.selected;
    let held = regard.held();
    let model = Model {
        object: regard.object(),
        is_movable: held.is_some() && !paused.0,
        dragging: *dragging,
        measuring: &measuring,
        keymap: &keymap,
    };
    let request = Panel::Pose.show(context, &mut panels, |ui| show(ui, &model));
    match (request.flatten(), held) {
        (Some(Request::MoveTo(location)), _) => {
            commands.write(Actor::Panel, HandCommand::MoveTo { hand, location });
        }
        (Some(Request::TurnTo(degrees)), Some(held)) => {
            let (axis, degrees) = turn_between(held.pose, degrees);
            let turn = HandCommand::Turn {
                hand,
                axis,
                degrees,
            };
            commands.write(Actor::Panel, turn);
        }
        (Some(Request::Drag(wished)), _) => *dragging = wished,
        (Some(Request::Measure), _) => measuring.switch(),
        (Some(Request::TurnTo(_)), None) | (None, _) => {}
    }
}

/// The axis and the angle, in degrees, of the turn from a pose to these angles.
fn turn_between(pose: Pose, degrees: Vec3) -> (Vec3, f32) {
    let turn = quat_from_degrees(degrees) * pose.rotation.inverse();
    let (axis, angle) = turn.to_axis_angle();
    match angle > std::f32::consts::PI {
        true => (-axis, 360.0 - angle.to_degrees()),
        false => (axis, angle.to_degrees()),
    }
}

fn show(ui: &mut Ui, model: &Model) -> Option<Request> {
    let id = model.object.map_or(NOTHING, |object| object.id);
    ui.label(RichText::new(id).strong());
    let numbers = ui.add_enabled_ui(model.is_movable, |ui| numbers(ui, model));
    let reason = "Only what the selected hand holds can be moved";
    numbers.response.on_disabled_hover_text(reason);
    ui.separator();
    let wished = toggles(ui, model);
    ui.separator();
    let measured = measurements(ui, model.measuring);
    numbers.inner.or(wished).or(measured)
}

fn numbers(ui: &mut Ui, model: &Model) -> Option<Request> {
    let pose = model.object.map_or(Pose::IDENTITY, |object| object.pose);
    let grid = egui::Grid::new("pose").num_columns(4);
    let rows = |ui: &mut Ui| {
        let range = -FARTHEST..=FARTHEST;
        let place = ["X", "Y", "Z"].map(|axis| format!("Location {axis}"));
        let location = row(ui, "Location", place, pose.location, range, |number| {
            number
                .speed(UNITS_A_PIXEL)
                .custom_formatter(|number, _| written(number, 2))
        });
        let angle = ["X", "Y", "Z"].map(|axis| format!("Angle {axis}"));
        let range = -180.0..=180.0;
        let degrees = row(ui, "Angles", angle, pose.degrees(), range, |number| {
            number
                .speed(DEGREES_A_PIXEL)
                .custom_formatter(|number, _| written(number, 1))
                .suffix("°")
        });
        location
            .map(Request::MoveTo)
            .or(degrees.map(Request::TurnTo))
    };
    grid.show(ui, rows).inner
}

/// A number with these decimals; what is nearly zero has no sign.
fn written(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    match is_zero {
        true => text.trim_start_matches('-').to_owned(),
        false => text,
    }
}

/// A row of three numbers; returns them if the user has changed one.
fn row(
    ui: &mut Ui,
    title: &str,
    names: [String; 3],
    mut value: Vec3,
    range: RangeInclusive<f32>,
    style: impl Fn(DragValue) -> DragValue,
) -> Option<Vec3> {
    ui.label(title);
    let mut is_changed = false;
    for (axis, label) in names.iter().enumerate() {
        let number = number_field(label, &mut value[axis], range.clone(), &style);
        is_changed |= ui.add(number).changed();
    }
    ui.end_row();
    is_changed.then_some(value)
}

/// The switch for measuring, and its results.
fn measurements(ui: &mut Ui, measuring: &Measuring) -> Option<Request> {
    let tooltip = "Click on two points for their distance, on a third for the angle at the second";
    let Vec3 { x, y, z } = measuring.way().unwrap_or_default();
    let distance = measuring.way().map_or_else(
        || "–".to_owned(),
        |way| format!("{:.2} units: {x:.2}, {y:.2}, {z:.2}", way.length()),
    );
    let angle = measuring.angle().map_or_else(
        || "–".to_owned(),
        |angle| format!("{:.1}°", angle.to_degrees()),
    );
    let row = |ui: &mut Ui| {
        let is_switched = switch(ui, measuring.is_on, "Measure", tooltip).clicked();
        ui.vertical(|ui| {
            ui.label(format!("Distance {distance}"));
            ui.label(format!("Angle {angle}"));
        });
        is_switched.then_some(Request::Measure)
    };
    ui.horizontal(row).inner
}

/// The ways of dragging that can be switched on and off.
fn toggles(ui: &mut Ui, model: &Model) -> Option<Request> {
    let mut dragging = model.dragging;
    ui.label("Dragging:");
    let upright = model.keymap.hint(Action::PlaneUpright);
    let level = format!(
        "A drag takes an object, moves it along the table and lets it go; the wheel, or {upright}, raises it. \
         Else a click takes it, and a drag moves it in the upright blue plane"
    );
    let step = format!("Turn in steps of {}°", Dragging::ANGLE_STEP);
    let grid = format!("Keep to a grid of {} units", Dragging::GRID);
    let choices = [
        (&mut dragging.is_level, "Along the table", level.as_str()),
        (
            &mut dragging.goes_on_top,
            "Onto objects",
            "Along the table: go over other objects, and stand on what is below",
        ),
        (
            &mut dragging.snaps_to_faces,
            "Snap to faces",
            "Get flush with a near face of another object",
        ),
        (
            &mut dragging.snaps_to_centers,
            "Snap to centres",
            "Get in line with the middle of another object nearby",
        ),
        (&mut dragging.snaps_to_grid, "Snap to grid", grid.as_str()),
        (&mut dragging.turns_in_steps, "Angle steps", step.as_str()),
    ];
    let rows = |ui: &mut Ui| {
        for (number, (is_on, label, tooltip)) in choices.into_iter().enumerate() {
            ui.checkbox(is_on, label).on_hover_text(tooltip);
            if number % 2 == 1 {
                ui.end_row();
            }
        }
    };
    egui::Grid::new("dragging").num_columns(2).show(ui, rows);
    (dragging != model.dragging).then_some(Request::Drag(dragging))
}

#[cfg(test)]
mod tests {
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::Hand;

    use super::*;

    struct Stage {
        is_movable: bool,
        dragging: Dragging,
        measuring: Measuring,
        keymap: Keymap,
        request: Option<Request>,
    }

    fn harness(is_movable: bool) -> Harness<'static, Stage> {
        let stage = Stage {
            is_movable,
            dragging: Dragging::default(),
            measuring: Measuring::default(),
            keymap: Keymap::default(),
            request: None,
        };
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let model = Model {
                object: Some(Regarded {
                    id: "red",
                    pose: Pose::from_degrees(Vec3::new(1.0, 2.0, 3.0), Vec3::Z * 90.0),
                    holder: Some(Hand::Any),
                }),
                is_movable: stage.is_movable,
                dragging: stage.dragging,
                measuring: &stage.measuring,
                keymap: &stage.keymap,
            };
            let request = show(ui, &model);
            stage.request = request.or(stage.request);
        };
        Harness::new_ui_state(frame, stage)
    }

    fn typed(name: &str, text: &str, is_movable: bool) -> Option<Request> {
        typed_until(egui::Key::Enter, name, text, is_movable)
    }

    fn typed_until(end: egui::Key, name: &str, text: &str, is_movable: bool) -> Option<Request> {
        let mut harness = harness(is_movable);
        harness.get_by_label(name).click();
        harness.run();
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.run();
        harness.event(egui::Event::Text(text.to_owned()));
        harness.run();
        harness.key_press(end);
        harness.run();
        harness.state().request
    }

    #[test]
    fn typed_numbers_move_and_turn_what_is_held() {
        let moved = Request::MoveTo(Vec3::new(1.0, -4.5, 3.0));
        assert_eq!(typed("Location Y", "-4.5", true), Some(moved));
        let Some(Request::TurnTo(degrees)) = typed("Angle X", "30", true) else {
            panic!("nothing is turned");
        };
        assert!(
            degrees.distance(Vec3::new(30.0, 0.0, 90.0)) < 1e-3,
            "{degrees}"
        );
        assert_eq!(typed("Location Y", "-4.5", false), None);
    }

    #[test]
    fn what_is_no_number_moves_nothing() {
        for text in ["2,25", "nan", "inf", "500", ""] {
            assert_eq!(typed("Location Y", text, true), None, "{text}");
        }
    }

    #[test]
    fn escape_drops_what_is_typed() {
        for name in ["Location Y", "Angle X"] {
            assert_eq!(typed_until(egui::Key::Escape, name, "-4.5", true), None);
        }
    }

    #[test]
    fn distances_and_angles_are_measured() {
        let mut harness = harness(true);
        for point in [Vec3::X * 3.0, Vec3::ZERO, Vec3::Y * 4.0] {
            harness.state_mut().measuring.add(point);
        }
        harness.run();
        for text in ["Distance 4.00 units: 0.00, 4.00, 0.00", "Angle 90.0°"] {
            assert!(harness.query_by_label(text).is_some(), "{text}");
        }
        harness.get_by_label("Measure").click();
        harness.run();
        assert_eq!(harness.state().request, Some(Request::Measure));
    }

    #[test]
    fn zero_has_no_sign() {
        let texts = [-0.001, 0.0, -1.25, 10.0].map(|number| written(number, 2));
        assert_eq!(texts, ["0.00", "0.00", "-1.25", "10.00"]);
    }

    #[test]
    fn a_turn_leads_from_the_pose_to_the_angles() {
        let from = Pose::from_degrees(Vec3::X, Vec3::new(20.0, -30.0, 100.0));
        for degrees in [[0.0, 0.0, 0.0], [90.0, 0.0, -170.0], [20.0, -30.0, 101.0]] {
            let (axis, angle) = turn_between(from, degrees.into());
            let turned = Quat::from_axis_angle(axis, angle.to_radians()) * from.rotation;
            let expected = quat_from_degrees(Vec3::from(degrees));
            assert!(turned.angle_between(expected) < 1e-3, "{degrees:?}");
            assert!(angle <= 180.0);
        }
    }

    #[test]
    fn each_way_of_dragging_is_switched() {
        let plain = Dragging::default();
        for (name, expected) in [
            (
                "Along the table",
                Dragging {
                    is_level: true,
                    ..plain
                },
            ),
            (
                "Onto objects",
                Dragging {
                    goes_on_top: false,
                    ..plain
                },
            ),
            (
                "Snap to faces",
                Dragging {
                    snaps_to_faces: true,
                    ..plain
                },
            ),
            (
                "Snap to centres",
                Dragging {
                    snaps_to_centers: true,
                    ..plain
                },
            ),
            (
                "Snap to grid",
                Dragging {
                    snaps_to_grid: true,
                    ..plain
                },
            ),
            (
                "Angle steps",
                Dragging {
                    turns_in_steps: true,
                    ..plain
                },
            ),
        ] {
            let mut harness = harness(true);
            harness.get_by_label(name).click();
            harness.run();
            assert_eq!(harness.state().request, Some(Request::Drag(expected)));
        }
    }
}
