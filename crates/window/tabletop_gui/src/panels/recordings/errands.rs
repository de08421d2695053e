//! Work on the selected recordings: export, variations, imitation.

use std::path::{Path, PathBuf};

use bevy_egui::egui::{ComboBox, Ui, WidgetType};
use tabletop_user::{Errand, ShelfOrder, ShelvedRecording};

use super::request::Request;
use crate::widgets::{button::button, name::name, number::number_field};

/// The formats of datasets, as the command line names them.
const FORMATS: [&str; 5] = ["lerobot", "robomimic", "rlds", "mcap", "mat"];

/// The most variations that are asked for.
const MOST: u32 = 10_000;

/// What is chosen for the work.
#[derive(Clone, Debug)]
pub(super) struct ErrandFields {
    format: usize,
    count: u32,
}

impl Default for ErrandFields {
    fn default() -> Self {
        Self {
            format: 0,
            count: 20,
        }
    }
}

/// Shows what can be done with recordings, and returns what the user wants. Only one piece of work is done at a time.
pub(super) fn show(
    ui: &mut Ui,
    selected: &[&ShelvedRecording],
    is_free: bool,
    fields: &mut ErrandFields,
) -> Option<Request> {
    let is_one = selected.len() == 1;
    let [first, ..] = selected else { return None };
    let mut errand = None;
    ui.horizontal_wrapped(|ui| {
        let format = FORMATS[fields.format];
        let tooltip = format!(
            "Writes the selected recordings as a dataset, into {}",
            place(first, format).display()
        );
        if button(ui, is_free, "Export", &tooltip).clicked() {
            errand = Some(Errand::Export {
                recordings: selected.iter().map(|it| it.folder.clone()).collect(),
                format: format.to_owned(),
                out: place(first, format),
            });
        }
        let list = ComboBox::from_id_salt("format")
            .width(84.0)
            .selected_text(format)
            .show_ui(ui, |ui| {
                for (index, format) in FORMATS.into_iter().enumerate() {
                    ui.selectable_value(&mut fields.format, index, format);
                }
            });
        name(&list.response, WidgetType::ComboBox, "Format");
        ui.separator();
        let out = place(first, "variations");
        let tooltip = format!(
            "Makes so many variations of the recording, into {}",
            out.display()
        );
        if button(ui, is_free && is_one, "Multiply", &tooltip).clicked() {
            errand = Some(Errand::Multiply {
                recording: first.folder.clone(),
                count: fields.count,
                out,
            });
        }
        let count = number_field("Variations", &mut fields.count, 1..=MOST, |count| count);
        let count = ui.add(count);
        count.on_hover_text("Number of variations");
        ui.separator();
        let out = place(first, "robot");
        let tooltip = format!(
            "The robot does what the recording shows, and is recorded in {}",
            out.display()
        );
        if button(ui, is_free && is_one, "Imitate", &tooltip).clicked() {
            errand = Some(Errand::Imitate {
                recording: first.folder.clone(),
                out,
            });
        }
    });
    errand.map(|errand| Request::Order(ShelfOrder::Begin(errand)))
}

/// The place of a result beside the recording of which it is made.
fn place(recording: &ShelvedRecording, kind: &str) -> PathBuf {
    let beside = recording.folder.parent().unwrap_or(Path::new(""));
    beside.join(format!("{}-{kind}", recording.name))
}
