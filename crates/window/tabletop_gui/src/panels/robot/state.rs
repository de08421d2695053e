//! The limbs side by side: positions of their joints, and objects in their grippers.

use bevy_egui::egui::{self, Label, RichText, Ui};
use tabletop_core::{JointId, LimbId};

use super::{model::Model, reading::reading};

/// Width of the table's columns for the arms, in points.
const ARM_WIDTH: f32 = 112.0;

const NOTHING: &str = "-";

/// The arms side by side.
pub(super) fn state(ui: &mut Ui, model: &Model, selected: JointId) {
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
            let blocked_by = model.robot.limb(limb).blocked_by.as_ref();
            blocked_by
                .map_or_else(|| NOTHING.into(), ToString::to_string)
                .into()
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
