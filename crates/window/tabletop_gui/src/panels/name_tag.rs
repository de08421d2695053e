//! The tag at the cursor: the name of the object there, who holds it, and during a drag its pose.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Area, Context, Frame, Id, Label, Order, RichText, pos2, vec2},
};
use tabletop_core::Hand;
use tabletop_input::{MouseGrip, Regard, Regarded};

/// From the tip of the cursor to the tag, in points.
const BESIDE: f32 = 18.0;

/// Width of the longest line, in points.
const WIDTH: f32 = 320.0;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, show_tag);
}

fn show_tag(mut contexts: EguiContexts, regard: Regard, grip: MouseGrip) {
    let (Ok(context), Some(cursor)) = (contexts.ctx_mut(), regard.cursor()) else {
        return;
    };
    let lines = match (grip.is_drag(), grip.is_on_camera()) {
        (true, _) => regard
            .held()
            .map(|held| vec![held.id.to_owned(), pose(held)]),
        (false, false) => regard.hovered().map(|hovered| vec![name(hovered)]),
        (false, true) => None,
    };
    if let Some(lines) = lines {
        show(context, cursor, &lines);
    }
}

fn show(context: &Context, cursor: Vec2, lines: &[String]) {
    let at = pos2(cursor.x, cursor.y) / context.zoom_factor() + vec2(BESIDE, BESIDE);
    Area::new(Id::new("name tag"))
        .order(Order::Tooltip)
        .fixed_pos(at)
        .interactable(false)
        .fade_in(false)
        .show(context, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(WIDTH);
                for (number, line) in lines.iter().enumerate() {
                    let text = match number {
                        0 => RichText::new(line).strong(),
                        _ => RichText::new(line).monospace(),
                    };
                    ui.add(Label::new(text).selectable(false).truncate());
                }
            });
        });
}

/// The name, and the hand that holds it.
fn name(object: Regarded) -> String {
    let holder = object.holder.map(|hand| match hand {
        Hand::Left => "in the left hand",
        Hand::Right => "in the right hand",
        Hand::Both => "in both hands",
        Hand::Any => "in a hand",
    });
    match holder {
        Some(holder) => format!("{}, {holder}", object.id),
        None => object.id.to_owned(),
    }
}

/// The pose, in units and degrees.
fn pose(object: Regarded) -> String {
    let Vec3 { x, y, z } = object.pose.location;
    let degrees = object.pose.degrees().round() + Vec3::ZERO;
    format!(
        "{x:.2} {y:.2} {z:.2}   {:.0}° {:.0}° {:.0}°",
        degrees.x, degrees.y, degrees.z
    )
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui;
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_geometry::Pose;

    use super::*;

    fn red(holder: Option<Hand>) -> Regarded<'static> {
        Regarded {
            id: "red",
            pose: Pose::from_degrees(Vec3::new(1.0, -2.345, 0.5), Vec3::new(0.0, -0.2, 90.0)),
            holder,
        }
    }

    #[test]
    fn the_tag_tells_name_holder_and_pose() {
        assert_eq!(name(red(None)), "red");
        assert_eq!(name(red(Some(Hand::Left))), "red, in the left hand");
        assert_eq!(pose(red(None)), "1.00 -2.35 0.50   0° 0° 90°");
    }

    #[test]
    fn the_tag_is_beside_the_cursor() {
        let frame = |ui: &mut egui::Ui| show(ui.ctx(), Vec2::new(100.0, 50.0), &["red".into()]);
        let harness = Harness::new_ui(frame);
        let tag = harness.get_by_label("red").rect();
        assert!(tag.left() > 100.0 && tag.top() > 50.0, "{tag}");
    }
}
