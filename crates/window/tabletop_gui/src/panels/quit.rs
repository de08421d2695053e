//! The question before the program ends in the middle of something.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Id, Modal, Ui},
};
use tabletop_core::Recording;
use tabletop_user::{Editing, QuitQuestion};

use crate::widgets::button::button;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Recording>()
        .add_systems(EguiPrimaryContextPass, show_question);
}

fn show_question(
    mut contexts: EguiContexts,
    mut question: ResMut<QuitQuestion>,
    recording: Res<Recording>,
    editing: Res<Editing>,
    mut exit: MessageWriter<AppExit>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let Some(loss) = question.loss(&recording, &editing) else {
        question.bypass_change_detection().close();
        return;
    };
    let modal = Modal::new(Id::new("quit")).show(context, |ui| show(ui, loss));
    if modal.inner == Some(true) {
        exit.write(AppExit::Success);
    }
    if modal.inner.is_some() || modal.should_close() {
        question.close();
    }
}

/// Returns the answer: true to quit.
fn show(ui: &mut Ui, loss: &str) -> Option<bool> {
    ui.set_width(360.0);
    ui.heading("Quit?");
    ui.label(loss);
    let buttons = ui.horizontal(|ui| {
        let quit = button(ui, true, "Quit", "Ends the program");
        let stay = button(ui, true, "Go on", "Goes back to the table (Esc)");
        (quit.clicked(), stay.clicked())
    });
    match buttons.inner {
        (true, _) => Some(true),
        (_, true) => Some(false),
        _ => None,
    }
}
