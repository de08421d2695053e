//! The Objects window (report section 6, figure 13): task files, presets, and the objects on the table.

mod inspector;
mod keys;
mod list;
mod new_objects;
mod present_object;
mod selection;
#[cfg(test)]
mod tests;

use std::path::PathBuf;

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        ComboBox, Direction, Id, InnerResponse, Layout, Response, Ui, WidgetInfo, WidgetType, vec2,
    },
};
use tabletop_core::{Actor, CommandWriter, Preset, SceneCommand};
use tabletop_user::{Action, Chosen, Keymap, PresetSeeds};

use self::{
    list::ListRequest,
    present_object::{OnTable, PresentObject},
    selection::Selection,
};
use crate::{
    files::{FileRequest, Files, TaskFile, short_name},
    panels::{Panel, Panels},
    widgets::button::button,
};

/// Width of the buttons at the right of the lists, in points.
const BUTTON_WIDTH: f32 = 84.0;

/// The entries of the second list.
const ENTRIES: [(&str, Entry); 6] = [
    ("Make a big block", Entry::Make(Preset::BigBlock)),
    ("Make a stack of 3 blocks", Entry::Make(Preset::Stack(3))),
    ("Make a stack of 5 blocks", Entry::Make(Preset::Stack(5))),
    ("Make a stack of 8 blocks", Entry::Make(Preset::Stack(8))),
    ("Make a box container", Entry::Make(Preset::BoxContainer)),
    ("Clear the table", Entry::Clear),
];

/// The action of an entry of the second list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Entry {
    Make(Preset),
    Clear,
}

/// The content of the panel.
struct Model<'a> {
    tasks: &'a [TaskFile],
    recent: &'a [PathBuf],
    objects: &'a [PresentObject],
    reloads: bool,
    keymap: &'a Keymap,
}

/// A wish of the user.
#[derive(Clone, Debug, PartialEq)]
enum Request {
    Load(PathBuf),
    Make(Preset),
    Clear,
    List(ListRequest),
    File(FileRequest),
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins(keys::plugin)
        .add_systems(EguiPrimaryContextPass, show_panel);
}

fn show_panel(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut selection: ResMut<Selection>,
    mut seeds: ResMut<PresetSeeds>,
    mut chosen: ResMut<Chosen>,
    mut commands: CommandWriter,
    mut file_requests: MessageWriter<FileRequest>,
    files: Res<Files>,
    keymap: Res<Keymap>,
    on_table: OnTable,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    if !panels.is_open(Panel::Objects) {
        return;
    }
    let objects = on_table.all();
    let model = Model {
        objects: &objects,
        tasks: &files.tasks,
        recent: &files.recent,
        reloads: files.reloads,
        keymap: &keymap,
    };
    let request = Panel::Objects.show(context, &mut panels, |ui| show(ui, &model, &mut selection));
    match request.flatten() {
        Some(Request::Load(path)) => {
            commands.write(Actor::Panel, SceneCommand::Load(path));
        }
        Some(Request::Make(preset)) => {
            commands.write(Actor::Panel, seeds.make(preset));
        }
        Some(Request::Clear) => {
            commands.write(Actor::Panel, SceneCommand::Clear);
        }
        Some(Request::List(ListRequest::Choose(id))) => {
            chosen.set_if_neq(Chosen(on_table.entity(&id)));
        }
        Some(Request::List(ListRequest::Edit(edits))) => {
            commands.write(Actor::Panel, SceneCommand::Edit(edits));
        }
        Some(Request::File(request)) => {
            file_requests.write(request);
        }
        None => {}
    }
}

fn show(ui: &mut Ui, model: &Model, selection: &mut Selection) -> Option<Request> {
    let tasks = tasks(ui, model, selection);
    let presets = presets(ui, model, selection);
    ui.separator();
    let files = files(ui, model);
    ui.separator();
    let list = list::show(ui, model.objects, &mut selection.objects);
    tasks.or(presets).or(files).or(list.map(Request::List))
}

fn tasks(ui: &mut Ui, model: &Model, selection: &mut Selection) -> Option<Request> {
    let selected = model
        .tasks
        .iter()
        .find(|task| Some(&task.path) == selection.task.as_ref())
        .or(model.tasks.first());
    let text = selected.map_or("no task files in tablesetup/", |task| &task.name);
    let mut chosen = None;
    let row = ui.horizontal(|ui| {
        let list = list(ui, "Task file", text, |ui| {
            for task in model.tasks {
                let is_selected = selected == Some(task);
                if ui.selectable_label(is_selected, &task.name).clicked() {
                    chosen = Some(task.path.clone());
                }
            }
        });
        let list = list.on_hover_text("The task files in the folder tablesetup/");
        let load = wide_button(
            ui,
            selected.is_some(),
            "Load XML",
            "Clears the table and loads the task file",
        );
        (list.clicked(), load.clicked())
    });
    selection.task = chosen.or(selection.task.take());
    match row.inner {
        (true, _) => Some(Request::File(FileRequest::ListTasks)),
        (_, true) => selected.map(|task| Request::Load(task.path.clone())),
        _ => None,
    }
}

fn presets(ui: &mut Ui, model: &Model, selection: &mut Selection) -> Option<Request> {
    let row = ui.horizontal(|ui| {
        let (text, _) = ENTRIES[selection.entry];
        let list = list(ui, "Preset objects", text, |ui| {
            for (index, (text, _)) in ENTRIES.into_iter().enumerate() {
                ui.selectable_value(&mut selection.entry, index, text);
            }
        });
        list.on_hover_text("Objects in random colours at a random free place");
        let (_, entry) = ENTRIES[selection.entry];
        let key = match entry {
            Entry::Make(Preset::BigBlock) => Some(Action::MakeBlock),
            Entry::Make(Preset::Stack(5)) => Some(Action::MakeStack),
            Entry::Make(Preset::Stack(_) | Preset::BoxContainer) => None,
            Entry::Clear => Some(Action::ClearTable),
        };
        let tooltip = match key {
            Some(action) => model.keymap.tooltip(action),
            None => "Makes these objects somewhere on the table".to_owned(),
        };
        wide_button(ui, true, "Execute", &tooltip)
            .clicked()
            .then_some(entry)
    });
    row.inner.map(|entry| match entry {
        Entry::Make(preset) => Request::Make(preset),
        Entry::Clear => Request::Clear,
    })
}

fn files(ui: &mut Ui, model: &Model) -> Option<Request> {
    let mut request = None;
    ui.horizontal(|ui| {
        let open = model.keymap.tooltip(Action::OpenFile);
        if button(ui, true, "Open…", &open).clicked() {
            request = Some(FileRequest::AskToOpen);
        }
        let save = model.keymap.tooltip(Action::SaveFile);
        if button(ui, true, "Save as…", &save).clicked() {
            request = Some(FileRequest::AskToSave);
        }
        ui.add_enabled_ui(!model.recent.is_empty(), |ui| {
            let menu = ui.menu_button("Recent", |ui| {
                for path in model.recent {
                    let entry = ui.button(short_name(path));
                    let entry = entry.on_hover_text(path.display().to_string());
                    if entry.clicked() {
                        request = Some(FileRequest::Open(path.clone()));
                    }
                }
            });
            menu.response
                .on_hover_text("Task files and recordings that were opened before")
                .on_disabled_hover_text("Nothing has been opened yet")
        });
    });
    let mut reloads = model.reloads;
    let check = ui.checkbox(&mut reloads, "Reload when the file changes");
    let check = check.on_hover_text(
        "Loads the task file again when another program has changed it, except while recording",
    );
    if check.changed() {
        request = Some(FileRequest::Reload(reloads));
    }
    request.map(Request::File)
}

/// A list that drops down, as wide as there is room for beside a button.
fn list(ui: &mut Ui, name: &str, selected: &str, entries: impl FnOnce(&mut Ui)) -> Response {
    let width = ui.available_width() - BUTTON_WIDTH - ui.spacing().item_spacing.x;
    let list = ComboBox::from_id_salt(Id::new(name))
        .width(width)
        .truncate()
        .height(320.0)
        .selected_text(selected);
    let InnerResponse { response, .. } = list.show_ui(ui, entries);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::ComboBox, true, name);
        info.current_text_value = Some(selected.to_owned());
        info
    });
    response
}

fn wide_button(ui: &mut Ui, is_enabled: bool, text: &str, tooltip: &str) -> Response {
    ui.allocate_ui_with_layout(
        vec2(BUTTON_WIDTH, ui.spacing().interact_size.y),
        Layout::centered_and_justified(Direction::TopDown),
        |ui| button(ui, is_enabled, text, tooltip),
    )
    .inner
}
