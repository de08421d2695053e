//! The program's own list of files, for desktops that have no dialog for it.

mod folder;
mod purpose;

pub use purpose::Purpose;

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{
        Id, Key, Label, Modal, RichText, ScrollArea, TextEdit, Ui,
        text::{CCursor, CCursorRange},
    },
};
use tabletop_core::is_shipped;

use self::folder::{EntryKind, FileEntry, FolderContent};
use crate::{
    files::{FileRequest, Files, TaskFile},
    widgets::button::button,
};

/// Size of the list in points.
const WIDTH: f32 = 420.0;
const HEIGHT: f32 = 300.0;

/// A window that shows a folder, in which the user chooses a file.
#[derive(Resource, Debug, Default)]
pub struct Browser {
    search: Option<FileSearch>,
}

/// The user's search.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FileSearch {
    purpose: Purpose,
    folder: FolderContent,
    /// The name that is selected or typed.
    name: String,
    /// The file that would be replaced.
    replaces: Option<PathBuf>,
    /// True until it is shown first, and takes the keyboard.
    is_new: bool,
}

/// A wish of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Request {
    Enter(PathBuf),
    Choose(PathBuf),
    Replace(PathBuf),
    Keep,
    Cancel,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Browser>()
        .add_systems(EguiPrimaryContextPass, show_browser);
}

impl Browser {
    /// Lets the user look for a file, first in this folder.
    pub fn ask(&mut self, purpose: Purpose, folder: &Path) {
        self.search = Some(FileSearch {
            purpose,
            folder: FolderContent::read(folder),
            name: purpose.file_name().into(),
            replaces: None,
            is_new: true,
        });
    }

    /// Carries out a request of the user, and returns one about a file.
    fn carry_out(&mut self, request: Request) -> Option<FileRequest> {
        let search = self.search.as_mut()?;
        let purpose = search.purpose;
        match request {
            Request::Enter(folder) => search.folder = FolderContent::read(&folder),
            Request::Keep => search.replaces = None,
            Request::Choose(path) if purpose != Purpose::Open && path.exists() => {
                search.replaces = Some(path);
            }
            Request::Choose(path) | Request::Replace(path) => {
                self.search = None;
                return Some(purpose.request(path));
            }
            Request::Cancel => self.search = None,
        }
        None
    }
}

fn show_browser(
    mut contexts: EguiContexts,
    mut browser: ResMut<Browser>,
    files: Res<Files>,
    mut requests: MessageWriter<FileRequest>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    let Some(search) = &mut browser.bypass_change_detection().search else {
        return;
    };
    let modal = Modal::new(Id::new("browser")).show(context, |ui| show(ui, search, &files.tasks));
    let cancelled = modal.should_close().then_some(Request::Cancel);
    if let Some(request) = modal.inner.or(cancelled) {
        requests.write_batch(browser.carry_out(request));
    }
}

fn show(ui: &mut Ui, search: &mut FileSearch, tasks: &[TaskFile]) -> Option<Request> {
    ui.set_width(WIDTH);
    let is_opening = search.purpose == Purpose::Open;
    let title = search.purpose.title();
    let verb = if is_opening { "Open" } else { "Save" };
    ui.heading(title);
    if let Some(path) = &search.replaces {
        return ask_to_replace(ui, path);
    }
    let place = place(ui, &search.folder);
    ui.separator();
    let offered = search.offered(tasks);
    let chosen = entries(ui, search, &offered);
    ui.separator();
    let mut is_entered = ui.memory(|memory| memory.focused().is_none());
    let enter = ui.input(|input| input.key_pressed(Key::Enter));
    if !is_opening {
        ui.horizontal(|ui| {
            let label = ui.label("File name:");
            let field = TextEdit::singleline(&mut search.name).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(label.id);
            is_entered |= field.lost_focus();
            let is_unnamed = enter && field.lost_focus() && search.name.trim().is_empty();
            let is_new = std::mem::take(&mut search.is_new);
            if is_new {
                select_stem(ui, field.id, &search.name);
            }
            if is_new || is_unnamed {
                field.request_focus();
            }
        });
    }
    let is_named = !search.name.trim().is_empty();
    let mut answer = (enter && is_entered && is_named).then(|| search.choose(&offered));
    ui.horizontal(|ui| {
        if button(ui, is_named, verb, title).clicked() {
            answer = Some(search.choose(&offered));
        }
        if button(ui, true, "Cancel", "Closes this window").clicked() {
            answer = Some(Request::Cancel);
        }
    });
    answer.or(place).or(chosen)
}

/// Selects the name without its ending, so that what is typed replaces it.
fn select_stem(ui: &Ui, field: Id, name: &str) {
    let stem = Path::new(name).file_stem().unwrap_or_default();
    let length = stem.to_string_lossy().chars().count();
    let mut state = TextEdit::load_state(ui.ctx(), field).unwrap_or_default();
    let stem = CCursorRange::two(CCursor::new(0), CCursor::new(length));
    state.cursor.set_char_range(Some(stem));
    TextEdit::store_state(ui.ctx(), field, state);
}

fn ask_to_replace(ui: &mut Ui, path: &Path) -> Option<Request> {
    ui.label(format!("{} exists. Replace it?", path.display()));
    let buttons = ui.horizontal(|ui| {
        let replace = button(ui, true, "Replace", "Replaces the content of the file");
        let keep = button(ui, true, "Keep it", "Goes back to choose another name");
        (replace.clicked(), keep.clicked())
    });
    match buttons.inner {
        (true, _) => Some(Request::Replace(path.to_owned())),
        (_, true) => Some(Request::Keep),
        _ => None,
    }
}

fn place(ui: &mut Ui, folder: &FolderContent) -> Option<Request> {
    ui.horizontal(|ui| {
        let above = folder.path.parent();
        let up = button(ui, above.is_some(), "Up", "Goes to the parent folder");
        ui.add(Label::new(folder.path.display().to_string()).truncate());
        up.clicked()
            .then(|| above.map(|above| Request::Enter(above.to_owned())))
    })
    .inner
    .flatten()
}

fn entries(ui: &mut Ui, search: &mut FileSearch, offered: &[&TaskFile]) -> Option<Request> {
    let mut request = None;
    let list = ScrollArea::vertical()
        .max_height(HEIGHT)
        .min_scrolled_height(HEIGHT);
    list.auto_shrink(false).show(ui, |ui| {
        if let Some(problem) = &search.folder.problem {
            ui.label(RichText::new(problem).color(ui.visuals().error_fg_color));
        } else if search.folder.entries.is_empty() {
            ui.weak("There are no folders, task files or recordings here.");
        }
        for FileEntry { kind, name } in &search.folder.entries {
            let text = match kind {
                EntryKind::Folder => format!("{name}/"),
                EntryKind::Recording => format!("{name} (recording)"),
                EntryKind::Task => name.clone(),
            };
            let entry = ui.selectable_label(search.name == *name, text);
            let is_entered = match kind {
                EntryKind::Folder => true,
                EntryKind::Recording => search.purpose != Purpose::Open,
                EntryKind::Task => false,
            };
            match is_entered {
                true => {
                    if entry.clicked() {
                        request = Some(Request::Enter(search.folder.path.join(name)));
                    }
                }
                false => {
                    if entry.clicked() {
                        search.name.clone_from(name);
                    }
                    if entry.double_clicked() {
                        request = Some(Request::Choose(search.folder.path.join(name)));
                    }
                }
            }
        }
        for TaskFile { name, path } in offered {
            let entry = ui.selectable_label(search.name == *name, name);
            if entry.clicked() {
                search.name.clone_from(name);
            }
            if entry.double_clicked() {
                request = Some(Request::Choose(path.clone()));
            }
        }
    });
    request
}

impl FileSearch {
    /// The task files inside the program, where the folder has none to be opened.
    fn offered<'a>(&self, tasks: &'a [TaskFile]) -> Vec<&'a TaskFile> {
        let mut entries = self.folder.entries.iter();
        let has_tasks = entries.any(|entry| entry.kind == EntryKind::Task);
        let is_offered = self.purpose == Purpose::Open && !has_tasks;
        let shipped = tasks.iter().filter(|task| is_shipped(&task.path));
        shipped.filter(|_| is_offered).collect()
    }

    /// Takes the selected or typed name.
    fn choose(&self, offered: &[&TaskFile]) -> Request {
        if let Some(task) = offered.iter().find(|task| task.name == self.name) {
            return Request::Choose(task.path.clone());
        }
        let mut path = self.folder.path.join(self.name.trim());
        let proposed = Path::new(self.purpose.file_name()).extension();
        if let Some(extension) = proposed.filter(|&proposed| path.extension() != Some(proposed)) {
            path.add_extension(extension);
        }
        Request::Choose(path)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use egui_kittest::{Harness, kittest::Queryable as _};

    /// A folder with a task file, a recording, and a folder with another task file.
    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("tabletop-browser-{name}-{}", std::process::id()));
        for file in [
            "a.xml",
            "demo/session.jsonl",
            "more/b.xml",
            ".hidden/c.xml",
            "notes.txt",
        ] {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    struct Stage {
        browser: Browser,
        tasks: Vec<TaskFile>,
        requests: Vec<FileRequest>,
    }

    fn harness(purpose: Purpose, folder: &Path) -> Harness<'static, Stage> {
        let mut browser = Browser::default();
        browser.ask(purpose, folder);
        let frame = |ui: &mut Ui, stage: &mut Stage| {
            let Some(search) = &mut stage.browser.search else {
                return;
            };
            if let Some(request) = show(ui, search, &stage.tasks) {
                stage.requests.extend(stage.browser.carry_out(request));
            }
        };
        let stage = Stage {
            browser,
            tasks: [
                ("mine.xml", "tablesetup/mine.xml"),
                ("tower.xml (shipped)", "shipped:tablesetup/tower.xml"),
            ]
            .map(|(name, path)| TaskFile {
                name: name.into(),
                path: path.into(),
            })
            .into(),
            requests: Vec::new(),
        };
        Harness::builder()
            .with_size([500.0, 500.0])
            .build_ui_state(frame, stage)
    }

    fn click(harness: &mut Harness<Stage>, names: &[&str]) {
        for name in names {
            harness.get_by_label(name).click();
            harness.run();
        }
    }

    #[test]
    fn a_folder_lists_folders_recordings_and_task_files() {
        let folder = folder("lists");
        let names: Vec<_> = FolderContent::read(&folder)
            .entries
            .into_iter()
            .map(|entry| entry.name)
            .collect();
        assert_eq!(names, ["more", "demo", "a.xml"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_task_file_or_a_recording_is_opened() {
        let folder = folder("open");
        for (names, path) in [
            (&["a.xml", "Open"][..], "a.xml"),
            (&["demo (recording)", "Open"], "demo"),
            (&["more/", "b.xml", "Open"], "more/b.xml"),
            (&["more/", "Up", "a.xml", "Open"], "a.xml"),
        ] {
            let mut harness = harness(Purpose::Open, &folder);
            click(&mut harness, names);
            let expected = FileRequest::Open(folder.join(path));
            assert_eq!(harness.state().requests, [expected]);
            assert!(harness.state().browser.search.is_none());
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn where_there_are_no_task_files_those_inside_the_program_are_offered() {
        let folder = folder("offered");
        let shipped = "tower.xml (shipped)";
        let mut harness = harness(Purpose::Open, &folder);
        assert!(harness.query_by_label(shipped).is_none());
        fs::remove_file(folder.join("a.xml")).unwrap();
        harness.state_mut().browser.ask(Purpose::Save, &folder);
        harness.run();
        assert!(harness.query_by_label(shipped).is_none());
        harness.state_mut().browser.ask(Purpose::Open, &folder);
        harness.run();
        assert!(harness.query_by_label("mine.xml").is_none());
        click(&mut harness, &[shipped, "Open"]);
        let expected = FileRequest::Open("shipped:tablesetup/tower.xml".into());
        assert_eq!(harness.state().requests, [expected]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn nothing_is_done_without_a_choice() {
        let folder = folder("nothing");
        let mut harness = harness(Purpose::Open, &folder);
        click(&mut harness, &["Open"]);
        assert!(harness.state().browser.search.is_some());
        click(&mut harness, &["Cancel"]);
        assert!(harness.state().browser.search.is_none());
        assert_eq!(harness.state().requests, []);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_file_is_saved_under_the_name_that_is_typed() {
        let folder = folder("save");
        for (typed, name) in [
            ("new", "new.xml"),
            ("new.xml", "new.xml"),
            ("new v1.2", "new v1.2.xml"),
        ] {
            let mut harness = harness(Purpose::Save, &folder);
            harness.state_mut().browser.search.as_mut().unwrap().name = typed.into();
            harness.run();
            click(&mut harness, &["Save"]);
            let expected = FileRequest::Save(folder.join(name));
            assert_eq!(harness.state().requests, [expected]);
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_file_that_exists_is_replaced_only_if_the_user_says_so() {
        let folder = folder("replace");
        let mut harness = harness(Purpose::Save, &folder);
        click(&mut harness, &["a.xml", "Save", "Keep it"]);
        assert_eq!(harness.state().requests, []);
        click(&mut harness, &["Save", "Replace"]);
        assert_eq!(
            harness.state().requests,
            [FileRequest::Save(folder.join("a.xml"))]
        );
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_name_field_has_the_keyboard_and_enter_saves() {
        let folder = folder("entered");
        let mut harness = harness(Purpose::Save, &folder);
        harness.run();
        assert!(harness.get_by_label("File name:").is_focused());
        harness.state_mut().browser.search.as_mut().unwrap().name = "new".into();
        harness.key_press(Key::Enter);
        harness.run();
        let expected = FileRequest::Save(folder.join("new.xml"));
        assert_eq!(harness.state().requests, [expected]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn without_a_name_enter_leaves_the_keyboard_to_the_name_field() {
        let folder = folder("unnamed");
        let mut harness = harness(Purpose::Save, &folder);
        harness.state_mut().browser.search.as_mut().unwrap().name = " ".into();
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(harness.state().requests, []);
        assert!(harness.get_by_label("File name:").is_focused());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_is_typed_replaces_the_proposed_name_and_keeps_its_ending() {
        let folder = folder("typed");
        let mut harness = harness(Purpose::Save, &folder);
        harness.run();
        harness.get_by_label("File name:").type_text("tower");
        harness.run();
        let search = harness.state().browser.search.as_ref().unwrap();
        assert_eq!(search.name, "tower.xml");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_that_cannot_be_read_says_so() {
        let harness = harness(Purpose::Open, Path::new("/no such folder"));
        let problem = harness.query_by_label_contains("no such folder cannot be read: ");
        assert!(problem.is_some());
    }
}
