//! The question before the program ends in the middle of something.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Id, Modal, Ui},
};
use tabletop_core::Recording;
use tabletop_user::Editing;

use crate::widgets::button::button;

/// Whether the user is asked.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct QuitQuestion {
    is_open: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<QuitQuestion>()
        .init_resource::<Recording>()
        .init_resource::<Editing>()
        .add_systems(EguiPrimaryContextPass, show_question);
}

impl QuitQuestion {
    /// Asks, if there is something to lose. True if it does.
    pub fn asks(&mut self, recording: &Recording, editing: &Editing) -> bool {
        self.is_open = reason(recording, editing).is_some();
        self.is_open
    }
}

/// What would be cut off, or lost.
fn reason(recording: &Recording, editing: &Editing) -> Option<&'static str> {
    if recording.0 {
        Some("A recording runs. It ends here if the program does.")
    } else if editing.is_unsaved {
        Some("The open recording has edits that are not saved. They are lost if the program ends.")
    } else {
        None
    }
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
    let Some(reason) = reason(&recording, &editing).filter(|_| question.is_open) else {
        question.bypass_change_detection().is_open = false;
        return;
    };
    let modal = Modal::new(Id::new("quit")).show(context, |ui| show(ui, reason));
    if modal.inner == Some(true) {
        exit.write(AppExit::Success);
    }
    if modal.inner.is_some() || modal.should_close() {
        question.is_open = false;
    }
}

/// Returns the answer: true to quit.
fn show(ui: &mut Ui, reason: &str) -> Option<bool> {
    ui.set_width(360.0);
    ui.heading("Quit?");
    ui.label(reason);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_asked_unless_something_is_lost() {
        let mut question = QuitQuestion::default();
        let edited = Editing {
            is_unsaved: true,
            ..default()
        };
        assert!(!question.asks(&Recording(false), &default()));
        assert!(question.asks(&Recording(false), &edited));
        assert!(question.asks(&Recording(true), &default()));
        assert!(reason(&Recording(true), &default()).is_some_and(|it| it.contains("recording")));
    }
}
