//! The Objects window (report section 6, figure 13): task files, presets, and the objects on the table.

mod inspector;
mod keys;
mod list;
mod new_objects;
mod present_object;
mod selection;

use std::path::PathBuf;

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        ComboBox, Direction, Id, InnerResponse, Layout, Response, Ui, WidgetInfo, WidgetType, vec2,
    },
};
use tabletop_core::{Actor, CommandWriter, Preset, SceneCommand};
use tabletop_user::{Action, Chosen, Keymap};

use self::{
    list::ListRequest,
    present_object::{OnTable, PresentObject},
    selection::Selection,
};
use crate::{
    files::{FileRequest, Files, TaskFile, short_name},
    panels::{Panel, Panels},
    preset_seeds::PresetSeeds,
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::{ObjectEdit, ObjectSpec, Shape};
    use tabletop_geometry::{Pose, Rgb};

    struct Stage {
        files: Files,
        keymap: Keymap,
        objects: Vec<PresentObject>,
        selection: Selection,
        requests: Vec<Request>,
    }

    fn harness(tasks: &[&str]) -> Harness<'static, Stage> {
        let tasks = tasks.iter().map(|name| TaskFile {
            name: (*name).to_owned(),
            path: Path::new("tablesetup").join(name),
        });
        let stage = Stage {
            files: Files {
                tasks: tasks.collect(),
                recent: vec!["/tasks/mine.xml".into(), "/recordings/demo".into()],
                reloads: false,
            },
            keymap: Keymap::default(),
            objects: Vec::new(),
            selection: Selection::default(),
            requests: Vec::new(),
        };
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let model = Model {
                objects: &stage.objects,
                tasks: &stage.files.tasks,
                recent: &stage.files.recent,
                reloads: stage.files.reloads,
                keymap: &stage.keymap,
            };
            stage
                .requests
                .extend(show(ui, &model, &mut stage.selection));
        };
        Harness::builder()
            .with_size([320.0, 900.0])
            .build_ui_state(frame, stage)
    }

    /// Clicks on the widgets of these names, one after the other, and returns their requests.
    fn clicked(harness: &mut Harness<Stage>, names: &[&str]) -> Vec<Request> {
        for name in names {
            harness.get_by_label(name).click();
            harness.run();
        }
        std::mem::take(&mut harness.state_mut().requests)
    }

    fn load(name: &str) -> Request {
        Request::Load(Path::new("tablesetup").join(name))
    }

    const LIST: Request = Request::File(FileRequest::ListTasks);

    #[test]
    fn the_first_task_file_is_loaded_or_the_one_that_is_chosen() {
        let mut harness = harness(&["a.xml", "b.xml", "c.xml"]);
        assert_eq!(clicked(&mut harness, &["Load XML"]), [load("a.xml")]);
        let chosen = clicked(&mut harness, &["Task file", "b.xml", "Load XML"]);
        assert_eq!(chosen, [LIST, load("b.xml")]);
    }

    #[test]
    fn a_chosen_file_that_has_gone_is_not_loaded() {
        let mut harness = harness(&["a.xml", "b.xml"]);
        clicked(&mut harness, &["Task file", "b.xml"]);
        harness.state_mut().files.tasks.pop();
        assert_eq!(clicked(&mut harness, &["Load XML"]), [load("a.xml")]);
        harness.state_mut().files.tasks.clear();
        harness.run();
        assert_eq!(clicked(&mut harness, &["Load XML"]), []);
    }

    #[test]
    fn every_preset_can_be_executed() {
        let mut harness = harness(&[]);
        assert_eq!(
            clicked(&mut harness, &["Execute"]),
            [Request::Make(Preset::BigBlock)]
        );
        for (text, entry) in ENTRIES {
            let wanted = clicked(&mut harness, &["Preset objects", text, "Execute"]);
            let expected = match entry {
                Entry::Make(preset) => Request::Make(preset),
                Entry::Clear => Request::Clear,
            };
            assert_eq!(wanted, [expected], "{text}");
        }
    }

    #[test]
    fn files_are_opened_and_saved() {
        for (names, request) in [
            (&["Open…"][..], FileRequest::AskToOpen),
            (&["Save as…"], FileRequest::AskToSave),
            (
                &["Recent", "mine.xml"],
                FileRequest::Open("/tasks/mine.xml".into()),
            ),
            (
                &["Recent", "demo"],
                FileRequest::Open("/recordings/demo".into()),
            ),
            (&["Reload when the file changes"], FileRequest::Reload(true)),
        ] {
            let mut harness = harness(&["a.xml"]);
            assert_eq!(clicked(&mut harness, names), [Request::File(request)]);
        }
    }

    #[test]
    fn without_recent_files_there_is_no_list_of_them() {
        let mut harness = harness(&["a.xml"]);
        harness.state_mut().files.recent.clear();
        harness.run();
        assert_eq!(clicked(&mut harness, &["Recent"]), []);
        assert!(harness.query_by_label("mine.xml").is_none());
    }

    fn with_objects() -> Harness<'static, Stage> {
        let mut harness = harness(&["a.xml"]);
        harness.state_mut().objects = [("ball", None), ("block", None), ("cap", Some("LeftHand"))]
            .map(|(id, holder)| PresentObject {
                spec: ObjectSpec::new(
                    id,
                    Pose::at(Vec3::new(id.len() as f32 * 2.0, 0.0, 0.5)),
                    1.0,
                    Shape::Sphere {
                        radius: 0.5,
                        color: Rgb::RED,
                    },
                ),
                holder: holder.map(str::to_owned),
            })
            .into();
        harness.run();
        harness
    }

    /// The edits that come of clicks on these widgets.
    fn edits(harness: &mut Harness<Stage>, names: &[&str]) -> Vec<ObjectEdit> {
        let requests = clicked(harness, names);
        requests
            .into_iter()
            .flat_map(|request| match request {
                Request::List(ListRequest::Edit(edits)) => edits,
                Request::List(ListRequest::Choose(_)) => Vec::new(),
                Request::Load(_) | Request::Make(_) | Request::Clear | Request::File(_) => {
                    panic!("{request:?}")
                }
            })
            .collect()
    }

    fn add_of(edits: &[ObjectEdit]) -> &ObjectSpec {
        let [ObjectEdit::Add(spec)] = edits else {
            panic!("{edits:?}");
        };
        spec
    }

    #[test]
    fn objects_are_made_duplicated_copied_and_deleted() {
        let mut harness = with_objects();
        let made = edits(&mut harness, &["New object", "Ring"]);
        assert_eq!(add_of(&made).shape.name(), "ring");
        let delete = edits(&mut harness, &["ball", "Delete"]);
        assert_eq!(delete, [ObjectEdit::Remove("ball".into())]);
        let copy = edits(&mut harness, &["Duplicate"]);
        let (copy, block) = (add_of(&copy), &harness.state().objects[1].spec);
        assert_eq!(copy.id, "ball");
        let apart = copy.pose.location.distance(block.pose.location);
        assert!(apart > 1.0, "in the place of the block: {apart}");
        assert_eq!(edits(&mut harness, &["Copy"]), []);
        assert_eq!(add_of(&edits(&mut harness, &["block", "Paste"])).id, "ball");
        assert_eq!(edits(&mut harness, &["cap", "Delete"]), [], "it is held");
    }

    #[test]
    fn a_property_is_changed_when_its_field_is_left() {
        let mut harness = with_objects();
        edits(&mut harness, &["block"]);
        harness.get_by_label("Id").focus();
        harness.run();
        harness.get_by_label("Id").type_text("s");
        harness.run();
        assert_eq!(harness.state().requests, []);
        harness.key_press(bevy_egui::egui::Key::Enter);
        harness.run();
        let changed = edits(&mut harness, &[]);
        let [ObjectEdit::Change { object, spec }] = &changed[..] else {
            panic!("{changed:?}");
        };
        assert_eq!((&**object, spec.id.contains('s')), ("block", true));
        assert_eq!(spec.pose, harness.state().objects[1].spec.pose);
    }

    #[test]
    fn a_renamed_object_stays_selected_also_when_undo_brings_back_its_id() {
        let mut harness = with_objects();
        edits(&mut harness, &["block"]);
        for id in ["s", "t"] {
            harness.get_by_label("Id").focus();
            harness.run();
            harness.get_by_label("Id").type_text(id);
            harness.key_press(bevy_egui::egui::Key::Enter);
            harness.run();
            let changed = edits(&mut harness, &[]);
            let [ObjectEdit::Change { spec, .. }] = &changed[..] else {
                panic!("{changed:?}");
            };
            harness.run();
            let before = harness.state().objects.clone();
            harness.state_mut().objects[1].spec = (**spec).clone();
            harness.run();
            assert!(harness.query_by_label("Id").is_some(), "renamed");
            harness.state_mut().objects = before;
            harness.run();
            assert!(harness.query_by_label("Id").is_some(), "undone");
        }
    }

    #[test]
    fn what_is_selected_in_the_list_is_chosen_for_the_keyboard() {
        let mut harness = with_objects();
        let chosen = Request::List(ListRequest::Choose("block".into()));
        assert_eq!(clicked(&mut harness, &["block"]), [chosen]);
    }

    #[test]
    fn several_are_moved_together() {
        let mut harness = with_objects();
        let list = &mut harness.state_mut().selection.objects;
        list.select_for_move(&["ball", "block"], [0.0, 2.0, 0.0]);
        harness.run();
        let moved = edits(&mut harness, &["Move"]);
        let places: Vec<_> = moved
            .iter()
            .map(|edit| match edit {
                ObjectEdit::Change { spec, .. } => spec.pose.location.y,
                ObjectEdit::Add(_) | ObjectEdit::Remove(_) => panic!("{edit:?}"),
            })
            .collect();
        assert_eq!(places, [2.0, 2.0]);
    }
}
