//! What is told of the selected recording, and the comparison of two.

use std::path::PathBuf;

use bevy_egui::egui::{RichText, TextEdit, Ui, Vec2, vec2};
use tabletop_user::{RecordingDigest, ShelfOrder, ShelvedRecording};

use super::{request::Request, rows};
use crate::{
    pictures::Pictures,
    widgets::{button::button, style::ACCENT},
};

/// Size of the pictures that are compared, in points.
const COMPARED: Vec2 = vec2(200.0, 150.0);

/// The name and notes of a recording as they are typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct EditedRecording {
    folder: PathBuf,
    name: String,
    notes: String,
}

/// Shows a recording, and returns what the user wants with it.
pub(super) fn show(
    ui: &mut Ui,
    recording: &ShelvedRecording,
    edited: &mut Option<EditedRecording>,
) -> Vec<Request> {
    let digest = recording
        .digest
        .as_ref()
        .and_then(|read| read.as_ref().ok());
    let notes = digest.map_or("", |digest| &digest.notes);
    let is_of_it = |edited: &EditedRecording| edited.folder == recording.folder;
    if !edited.as_ref().is_some_and(is_of_it) {
        *edited = Some(EditedRecording {
            folder: recording.folder.clone(),
            name: recording.name.clone(),
            notes: notes.to_owned(),
        });
    }
    let mut requests = Vec::new();
    let folder = || recording.folder.clone();
    if let Some(fields) = edited {
        ui.horizontal(|ui| {
            let open = "Shows it in Timeline: play it, edit it, let the robot imitate it";
            if button(ui, true, "Open", open).clicked() {
                requests.push(Request::Open(folder()));
            }
            let label = ui.label("Name:");
            let room = ui.available_width() - 140.0;
            let field = TextEdit::singleline(&mut fields.name).desired_width(room);
            let field = ui.add(field).labelled_by(label.id);
            let is_new = fields.name != recording.name;
            let renames = button(ui, is_new, "Rename", "Gives its folder this name").clicked();
            if renames || (is_new && field.lost_focus() && entered(ui)) {
                let order = ShelfOrder::Rename(folder(), fields.name.clone());
                requests.push(Request::Order(order));
            }
            let delete = "Moves it to the folder trash beside it; nothing is lost";
            if button(ui, true, "Delete", delete).clicked() {
                requests.push(Request::Order(ShelfOrder::Discard(folder())));
            }
        });
        if let Some(digest) = digest {
            sentences(ui, digest, None);
        } else if let Some(Err(reason)) = &recording.digest {
            ui.label(reason);
        }
        ui.horizontal(|ui| {
            let label = ui.label("Notes:");
            let field = TextEdit::multiline(&mut fields.notes)
                .desired_rows(1)
                .desired_width(ui.available_width());
            let field = ui.add(field).labelled_by(label.id);
            if field.lost_focus() && fields.notes.trim() != notes.trim() {
                let order = ShelfOrder::Note(folder(), fields.notes.clone());
                requests.push(Request::Order(order));
            }
        });
    }
    requests
}

fn entered(ui: &Ui) -> bool {
    ui.input(|input| input.key_pressed(bevy_egui::egui::Key::Enter))
}

/// Shows two recordings beside each other; what only one of them has stands out.
pub(super) fn compare(ui: &mut Ui, pair: [&ShelvedRecording; 2], pictures: &mut Pictures) {
    let read = pair.map(|recording| recording.digest.as_ref()?.as_ref().ok());
    ui.columns(2, |columns| {
        for (index, ui) in columns.iter_mut().enumerate() {
            ui.strong(&pair[index].name);
            let Some(digest) = read[index] else {
                ui.weak("It has not been read.");
                continue;
            };
            rows::picture(ui, Some(digest), COMPARED, pictures);
            ui.label(rows::measures(digest));
            sentences(ui, digest, read[1 - index]);
            if !digest.notes.is_empty() {
                ui.label(RichText::new(&digest.notes).weak().italics());
            }
        }
    });
}

/// The sentences of a recording's task; those that the other one has not stand out.
fn sentences(ui: &mut Ui, digest: &RecordingDigest, other: Option<&RecordingDigest>) {
    if digest.sentences.is_empty() {
        ui.label("Nothing is moved for good.");
    }
    for (number, sentence) in (1..).zip(&digest.sentences) {
        let text = RichText::new(format!("{number}. {sentence}"));
        let is_own = other.is_some_and(|other| !other.sentences.contains(sentence));
        ui.label(if is_own { text.color(ACCENT) } else { text });
    }
}
