//! The name, number and notes of the next take.

use bevy::prelude::*;
use bevy_egui::{
    EguiContext, PrimaryEguiContext,
    egui::{Id, TextEdit, Ui},
};
use tabletop_user::{Action, Chosen, KeySystems, NextTake, was_struck};

use crate::{
    panels::{Panel, Panels},
    widgets::focus,
};

/// Width of the names of the fields, in points.
const NAME_WIDTH: f32 = 44.0;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        go_to_name
            .run_if(was_struck(Action::NameTake))
            .in_set(KeySystems),
    );
}

fn go_to_name(
    mut contexts: Query<&mut EguiContext, With<PrimaryEguiContext>>,
    mut panels: ResMut<Panels>,
    mut chosen: ResMut<Chosen>,
) {
    panels.set_open(Panel::DemonstrationTools, true);
    chosen.set_if_neq(Chosen(None));
    for mut context in &mut contexts {
        focus::call(context.get_mut(), name_id());
    }
}

pub(super) fn name_id() -> Id {
    Id::new("name of the takes")
}

/// Shows what is to be said of a take before it begins; of one that is recorded, only the notes can still be changed.
pub(super) fn show(ui: &mut Ui, take: &mut NextTake, is_recording: bool) {
    row(ui, "Name:", |ui, label| {
        let number = match is_recording || take.name.is_empty() {
            true => String::new(),
            false => format!("take {}", take.number),
        };
        let room = ui.available_width() - NAME_WIDTH - 12.0;
        let field = TextEdit::singleline(&mut take.name)
            .hint_text("demo")
            .desired_width(room);
        let field = ui.add_enabled(!is_recording, field).labelled_by(label);
        focus::answer(&field, name_id());
        let folder = take.folder();
        let tooltip = format!(
            "Takes of one name are numbered: NAME-01, NAME-02, …\nThe next one is {}",
            folder.display()
        );
        field
            .on_hover_text(tooltip)
            .on_disabled_hover_text("It can be renamed in Recordings when it has ended");
        ui.label(number);
    });
    take.name = NextTake::usable_name(&take.name);
    row(ui, "Notes:", |ui, label| {
        let field = TextEdit::singleline(&mut take.notes)
            .hint_text("kept with the recording")
            .desired_width(f32::INFINITY);
        ui.add(field).labelled_by(label);
    });
}

fn row(ui: &mut Ui, name: &str, field: impl FnOnce(&mut Ui, Id)) {
    ui.horizontal(|ui| {
        let start = ui.cursor().left();
        let label = ui.label(name).id;
        ui.add_space((start + NAME_WIDTH - ui.cursor().left()).max(0.0));
        field(ui, label);
    });
}
