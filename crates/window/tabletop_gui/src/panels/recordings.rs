//! The Recordings window: those of a folder, with their pictures and sentences, and what can be done with them.

mod details;
mod errands;
mod request;
mod rows;

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{ProgressBar, ScrollArea, TextEdit, Ui},
};
use tabletop_core::OpenRecording;
use tabletop_user::{NextTake, RunningErrand, Shelf, ShelfOrder, ShelvedRecording};

use self::request::Request;
use crate::{
    panels::{Panel, Panels},
    pictures::Pictures,
    widgets::button::button,
};

/// Height of the list in points.
const LIST_HEIGHT: f32 = 250.0;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<RecordingsView>()
        .add_message::<OpenRecording>()
        .add_systems(EguiPrimaryContextPass, show_panel);
}

/// What the user has selected and typed in the window.
#[derive(Resource, Default)]
pub(crate) struct RecordingsView {
    /// The folder as it is typed.
    typed_folder: Option<String>,
    /// The folders of the selected recordings, in the order in which they were selected.
    selected: Vec<PathBuf>,
    /// The new name and notes of the selected one, as they are typed.
    edited: Option<details::EditedRecording>,
    errands: errands::ErrandFields,
    pictures: Pictures,
    /// The folder that was looked at, while the window is open.
    looked_at: Option<PathBuf>,
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut view: ResMut<RecordingsView>,
    mut take: ResMut<NextTake>,
    mut orders: MessageWriter<ShelfOrder>,
    mut opened: MessageWriter<OpenRecording>,
    shelf: Res<Shelf>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let view = view.bypass_change_detection();
    if !panels.is_open(Panel::Recordings) {
        view.looked_at = None;
        return;
    }
    if view.looked_at.as_ref() != Some(&take.shelf) {
        view.looked_at = Some(take.shelf.clone());
        orders.write(ShelfOrder::Look(take.shelf.clone()));
    }
    let shown = Panel::Recordings.show(context, &mut panels, |ui| {
        show(ui, &shelf, &take.shelf, view)
    });
    for request in shown.unwrap_or_default() {
        match request {
            Request::Choose(folder) => take.shelf = folder,
            Request::Open(folder) => {
                let folder = std::path::absolute(&folder).unwrap_or(folder);
                opened.write(OpenRecording(folder));
            }
            Request::Order(order) => {
                orders.write(order);
            }
        }
    }
}

/// Shows the window's contents, and returns the user's requests.
fn show(ui: &mut Ui, shelf: &Shelf, chosen: &Path, view: &mut RecordingsView) -> Vec<Request> {
    view.pictures.begin_frame(&shelf.folder);
    view.selected
        .retain(|folder| shelf.recordings.iter().any(|it| it.folder == *folder));
    let mut requests = Vec::new();
    requests.extend(folder(ui, chosen, &mut view.typed_folder));
    requests.extend(
        shelf
            .errand
            .as_ref()
            .and_then(|errand| progress(ui, errand)),
    );
    list(ui, shelf, view);
    ui.separator();
    let selected: Vec<_> = view
        .selected
        .iter()
        .filter_map(|folder| shelf.recordings.iter().find(|it| it.folder == *folder))
        .collect();
    match selected[..] {
        [] => {
            ui.weak("Click a recording; with Ctrl, click another one to compare them.");
        }
        [one] => requests.extend(details::show(ui, one, &mut view.edited)),
        [one, other] => details::compare(ui, [one, other], &mut view.pictures),
        _ => {
            ui.label(format!("{} recordings", selected.len()));
        }
    }
    if !selected.is_empty() {
        let is_free = shelf.errand.is_none();
        requests.extend(errands::show(ui, &selected, is_free, &mut view.errands));
    }
    requests
}

/// The folder, in which the next recording is made, too.
fn folder(ui: &mut Ui, chosen: &Path, typed: &mut Option<String>) -> Option<Request> {
    ui.horizontal(|ui| {
        let label = ui.label("Folder:");
        let mut text = typed
            .clone()
            .unwrap_or_else(|| chosen.display().to_string());
        let field = TextEdit::singleline(&mut text)
            .hint_text("the working folder")
            .desired_width(ui.available_width() - 76.0);
        let field = ui.add(field).labelled_by(label.id);
        let field = field.on_hover_text("The folder of these recordings, and of the next ones");
        if field.changed() {
            *typed = Some(text.clone());
        }
        let again = button(ui, true, "Refresh", "Reads the folder anew");
        if field.lost_focus() && typed.take().is_some() {
            return Some(Request::Choose(text.trim().into()));
        }
        let look = ShelfOrder::Look(chosen.to_owned());
        again.clicked().then_some(Request::Order(look))
    })
    .inner
}

/// The work that is being done, and the button that ends it.
fn progress(ui: &mut Ui, running: &RunningErrand) -> Option<Request> {
    let (part, text) = match running.progress {
        Some((done, all)) => (done as f32 / all.max(1) as f32, format!("{done} of {all}")),
        None => (0.0, "working …".to_owned()),
    };
    ui.label(running.errand.sentence());
    ui.horizontal(|ui| {
        let bar = ProgressBar::new(part)
            .desired_width(ui.available_width() - 70.0)
            .text(text);
        ui.add(bar);
        let cancel = "Ends it; what is complete by then stays";
        let cancel = button(ui, true, "Cancel", cancel);
        cancel
            .clicked()
            .then_some(Request::Order(ShelfOrder::Cancel))
    })
    .inner
}

fn list(ui: &mut Ui, shelf: &Shelf, view: &mut RecordingsView) {
    if let Some(problem) = &shelf.problem {
        ui.colored_label(ui.visuals().error_fg_color, problem);
        return;
    }
    if shelf.recordings.is_empty() {
        ui.weak("There are no recordings here. Make one with Start in Demonstration Tools.");
        return;
    }
    let unread = shelf.recordings.iter().filter(|it| it.digest.is_none());
    let count = match unread.count() {
        0 => counted(shelf.recordings.len()),
        unread => format!("{}, {unread} being read", counted(shelf.recordings.len())),
    };
    ui.weak(count);
    let rows = shelf.recordings.len();
    ScrollArea::vertical()
        .max_height(LIST_HEIGHT)
        .auto_shrink([false, true])
        .show_rows(ui, rows::HEIGHT, rows, |ui, seen| {
            for recording in &shelf.recordings[seen] {
                let is_selected = view.selected.contains(&recording.folder);
                let row = rows::show(ui, recording, is_selected, &mut view.pictures);
                if row.clicked() {
                    let adds = ui.input(|input| input.modifiers.command);
                    select(&mut view.selected, recording, adds);
                }
            }
        });
}

fn counted(recordings: usize) -> String {
    match recordings {
        1 => "1 recording".into(),
        many => format!("{many} recordings"),
    }
}

/// Selects a recording, or takes it in or out beside others.
fn select(selected: &mut Vec<PathBuf>, recording: &ShelvedRecording, adds: bool) {
    let folder = &recording.folder;
    let was_there = selected.contains(folder);
    match adds {
        true => selected.retain(|it| it != folder),
        false => selected.clear(),
    }
    if !(adds && was_there) {
        selected.push(folder.clone());
    }
}

#[cfg(test)]
mod tests;
