//! Files that the user opens and saves while the window is open.

mod dialog;
mod film;
mod kind;
mod picture;
mod plot;
mod recent;
mod reload;

use std::path::{Path, PathBuf};

use bevy::{ecs::system::SystemState, prelude::*, window::FileDragAndDrop};
use tabletop_core::{
    Actor, OpenRecording, SceneCommand, ShippedFiles, WriteCommand as _, is_shipped,
};
use tabletop_gui::{FileRequest, Files, Purpose, TaskFile};
use tabletop_user::{Notices, Tone};

use self::{
    dialog::Dialog,
    film::Filming,
    kind::FileKind,
    recent::remember,
    reload::{Watch, keep_setting},
};
use tabletop_sim::task_files::{TASK_FOLDER, is_task_file, save_task, task_files};
use tabletop_xml::AllowedFolders;

pub(super) fn plugin(app: &mut App) {
    app.add_plugins((recent::plugin, reload::plugin))
        .init_resource::<Dialog>()
        .init_resource::<Filming>()
        .init_resource::<ShippedFiles>()
        .init_resource::<AllowedFolders>()
        .add_systems(Startup, |mut requests: MessageWriter<FileRequest>| {
            requests.write(FileRequest::ListTasks);
        })
        .add_systems(
            Update,
            (
                take_dropped,
                dialog::take_answer,
                carry_out,
                film::take_result,
            )
                .chain(),
        );
}

fn take_dropped(
    mut drops: MessageReader<FileDragAndDrop>,
    mut requests: MessageWriter<FileRequest>,
) {
    for drop in drops.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = drop {
            requests.write(FileRequest::Open(path_buf.clone()));
        }
    }
}

fn carry_out(world: &mut World, reader: &mut SystemState<MessageReader<FileRequest>>) -> Result {
    let requests: Vec<_> = reader.get_mut(world)?.read().cloned().collect();
    for request in requests {
        match request {
            FileRequest::ListTasks => list_tasks(world),
            FileRequest::AskToOpen => dialog::ask(world, Purpose::Open),
            FileRequest::AskToSave => dialog::ask(world, Purpose::Save),
            FileRequest::AskForVideo => dialog::ask(world, Purpose::Video),
            FileRequest::AskForPicture(size) => dialog::ask(world, Purpose::Picture(size)),
            FileRequest::AskForTable => dialog::ask(world, Purpose::Table),
            FileRequest::AskForPlot => dialog::ask(world, Purpose::Plot),
            FileRequest::SaveTable(path) => plot::save_table(world, &path),
            FileRequest::SavePlot(path) => plot::save_picture(world, path),
            FileRequest::SaveVideo(path) => film::begin(world, path),
            FileRequest::SavePicture(path, size) => picture::save(world, &path, size),
            FileRequest::Open(path) => open(world, &path),
            FileRequest::Save(path) => save(world, &path),
            FileRequest::Reload(reloads) => keep_setting(world, reloads),
        }
    }
    Ok(())
}

fn list_tasks(world: &mut World) {
    let own = task_files(Path::new(TASK_FOLDER));
    let tasks = listed(&own, world.resource::<ShippedFiles>());
    world.resource_mut::<Files>().tasks = tasks;
}

/// A folder's own files, then those inside the program that have no namesake there.
fn listed(own: &[PathBuf], shipped: &ShippedFiles) -> Vec<TaskFile> {
    let shipped = shipped.in_folder(TASK_FOLDER).filter(|file| {
        let path = Path::new(file.path);
        is_task_file(path, file.text.as_bytes()) && !own.iter().any(|own| own == path)
    });
    let shipped = shipped.map(|file| TaskFile {
        name: format!("{} (shipped)", name(Path::new(file.path))),
        path: file.name(),
    });
    let own = own.iter().map(|path| TaskFile {
        name: name(path),
        path: path.clone(),
    });
    own.chain(shipped).collect()
}

fn open(world: &mut World, path: &Path) {
    if is_shipped(path) {
        world.write_command_of(Actor::Panel, SceneCommand::Load(path.to_owned()));
        return;
    }
    let path = std::path::absolute(path).unwrap_or(path.to_owned());
    match FileKind::of(&path) {
        Ok(FileKind::Task) => {
            world.write_command_of(Actor::Panel, SceneCommand::Load(path.clone()));
            remember(world, path);
        }
        Ok(FileKind::Recording(folder)) => {
            world.write_message(OpenRecording(folder.clone()));
            remember(world, folder);
        }
        Err(reason) => tell(world, Tone::Fault, &reason),
    }
}

fn save(world: &mut World, path: &Path) {
    match save_task(world, path) {
        Ok(unsaid) => {
            tell(world, Tone::Event, &format!("{} is saved", path.display()));
            for unsaid in unsaid {
                let unsaid = format!("{}: {unsaid}", name(path));
                tell(world, Tone::Warning, &unsaid);
            }
            world.resource_mut::<Watch>().note_saved(path);
            remember(world, path.to_owned());
            list_tasks(world);
        }
        Err(error) => {
            let reason = format!("{} cannot be saved: {error}", path.display());
            tell(world, Tone::Fault, &reason);
        }
    }
}

fn tell(world: &mut World, tone: Tone, text: &str) {
    world.resource_mut::<Notices>().renew(tone, text);
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tabletop_core::{
        CommandId, CorePlugin, IssuedCommand, Recording, SceneFact, ShippedFile, SimCommand,
        SimFact,
    };
    use tabletop_gui::{Browser, Preferences};

    use super::*;
    use tabletop_scene::ScenePlugin;

    use crate::test_folder::TestFolder;

    /// A folder with a task file, a recording and something else.
    fn folder(name: &str) -> TestFolder {
        let folder = TestFolder::new(&format!("files-{name}"));
        for (path, text) in [
            ("task.xml", TASK),
            ("demo/session.jsonl", ""),
            ("demo/0/15.png", ""),
            ("notes.txt", ""),
        ] {
            folder.write(path, text);
        }
        folder
    }

    const TASK: &str = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'>\
                        <sphere location='(0,0,1)'/></tabletop>";

    fn app(folder: &Path) -> App {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            tabletop_physics::PhysicsPlugin::default(),
            ScenePlugin,
        ))
        .insert_resource(Preferences::in_folder(folder.join("config")))
        .init_resource::<Files>()
        .init_resource::<Notices>()
        .init_resource::<Browser>()
        .add_message::<FileRequest>()
        .add_message::<FileDragAndDrop>()
        .add_plugins(plugin);
        app.finish();
        app.cleanup();
        app.update();
        app
    }

    fn ask(app: &mut App, request: FileRequest) {
        app.world_mut().write_message(request);
        app.update();
    }

    fn written<M: Message + Clone>(app: &App) -> Vec<M> {
        let messages = app.world().resource::<Messages<M>>();
        messages.get_cursor().read(messages).cloned().collect()
    }

    fn commands_of(app: &App) -> Vec<SimCommand> {
        let issued = written::<IssuedCommand>(app);
        issued.into_iter().map(|issued| issued.command).collect()
    }

    fn reported(app: &App) -> Vec<String> {
        let notices = app.world().resource::<Notices>();
        notices.iter().map(str::to_owned).collect()
    }

    fn recent(app: &App) -> Vec<PathBuf> {
        app.world().resource::<Files>().recent.clone()
    }

    #[test]
    fn files_dropped_onto_the_window_are_opened() {
        let folder = folder("dropped");
        let drop = |app: &mut App, path: &str| {
            app.world_mut().write_message(FileDragAndDrop::DroppedFile {
                window: Entity::PLACEHOLDER,
                path_buf: folder.join(path),
            });
            app.update();
        };
        let mut task = app(&folder);
        drop(&mut task, "task.xml");
        assert_eq!(
            commands_of(&task),
            [SimCommand::Scene(SceneCommand::Load(
                folder.join("task.xml")
            ))]
        );
        for path in ["demo", "demo/session.jsonl", "demo/0/15.png"] {
            let mut recording = app(&folder);
            drop(&mut recording, path);
            let opened = written::<OpenRecording>(&recording);
            assert_eq!(opened, [OpenRecording(folder.join("demo"))], "{path}");
        }
        for path in ["notes.txt", "missing.xml", ""] {
            let mut other = app(&folder);
            drop(&mut other, path);
            assert_eq!(reported(&other).len(), 1, "{path}");
            assert!(commands_of(&other).is_empty());
            assert!(written::<OpenRecording>(&other).is_empty());
        }
    }

    #[test]
    fn files_inside_the_program_are_listed_after_those_of_the_folder() {
        let shipped = [
            "tablesetup/default.xml",
            "tablesetup/mine.xml",
            "tablesetup/a.xsd",
        ];
        let shipped = shipped.map(|path| ShippedFile { path, text: TASK });
        let own = ["a.xml", "default.xml"].map(|name| Path::new(TASK_FOLDER).join(name));
        let tasks = listed(&own, &ShippedFiles::new(shipped));
        let names: Vec<_> = tasks.iter().map(|task| &*task.name).collect();
        assert_eq!(names, ["a.xml", "default.xml", "mine.xml (shipped)"]);
        assert_eq!(tasks[2].path, shipped[1].name());
    }

    #[test]
    fn a_file_inside_the_program_is_opened_and_not_remembered() {
        let folder = folder("inside");
        let mut app = app(&folder);
        let path = PathBuf::from("shipped:tablesetup/mine.xml");
        ask(&mut app, FileRequest::Open(path.clone()));
        let load = SceneCommand::Load(path);
        assert_eq!(commands_of(&app), [SimCommand::Scene(load)]);
        assert!(recent(&app).is_empty());
    }

    #[test]
    fn recent_files_are_remembered_between_runs_as_long_as_they_are_there() {
        let folder = folder("recent");
        let mut first = app(&folder);
        for path in ["task.xml", "demo", "task.xml"] {
            ask(&mut first, FileRequest::Open(folder.join(path)));
        }
        let expected = [folder.join("task.xml"), folder.join("demo")];
        assert_eq!(recent(&first), expected);
        assert_eq!(recent(&app(&folder)), expected);
        fs::remove_file(folder.join("task.xml")).unwrap();
        assert_eq!(recent(&app(&folder)), [folder.join("demo")]);
    }

    #[test]
    fn a_saved_state_is_reported_and_remembered() {
        let folder = folder("saved");
        let mut app = app(&folder);
        let path = folder.join("saved.xml");
        ask(&mut app, FileRequest::Save(path.clone()));
        assert_eq!(reported(&app), [format!("{} is saved", path.display())]);
        assert_eq!(recent(&app), std::slice::from_ref(&path));
        let task = tabletop_xml::read_task(&path).unwrap();
        assert_eq!((task.scene, task.faults), default());
        ask(
            &mut app,
            FileRequest::Save(folder.join("missing/saved.xml")),
        );
        assert!(
            reported(&app)[1].contains("cannot be saved: "),
            "{:?}",
            reported(&app)
        );
    }

    /// An app whose task file is loaded and then changed, some seconds ago.
    fn changed(folder: &Path, text: &str, reloads: bool, is_recording: bool) -> App {
        let mut app = app(folder);
        let path = folder.join("task.xml");
        app.world_mut().resource_mut::<Files>().reloads = reloads;
        app.world_mut().resource_mut::<Recording>().0 = is_recording;
        app.world_mut()
            .write_message(SimFact::Scene(SceneFact::TaskLoaded {
                cause: CommandId(0),
                path: path.clone(),
                faults: Vec::new(),
            }));
        app.update();
        fs::write(&path, text).unwrap();
        app.world_mut().run_system_cached(reload::reload).unwrap();
        app
    }

    #[test]
    fn a_task_file_that_changes_is_loaded_anew_if_the_user_wants_it() {
        let folder = folder("reload");
        let larger = TASK.replace("(0,0,1)", "(0,0,10)");
        let load = [SimCommand::Scene(SceneCommand::Load(
            folder.join("task.xml"),
        ))];
        assert_eq!(commands_of(&changed(&folder, &larger, false, false)), []);
        let mut app = changed(&folder, TASK, true, false);
        assert_eq!(commands_of(&app), load);
        app.world_mut().run_system_cached(reload::reload).unwrap();
        assert_eq!(commands_of(&app), load, "it is loaded once");
    }

    #[test]
    fn a_change_of_an_included_file_loads_the_task_anew() {
        let folder = folder("included");
        fs::write(folder.join("other.xml"), TASK).unwrap();
        let including = TASK.replace("<sphere", "<include file='other.xml'/><sphere");
        assert_ne!(including, TASK);
        fs::write(folder.join("task.xml"), &including).unwrap();
        let mut app = changed(&folder, &including, true, false);
        let before = commands_of(&app).len();
        let larger = TASK.replace("(0,0,1)", "(0,0,10)");
        fs::write(folder.join("other.xml"), larger).unwrap();
        app.world_mut().run_system_cached(reload::reload).unwrap();
        let load = SimCommand::Scene(SceneCommand::Load(folder.join("task.xml")));
        assert_eq!(commands_of(&app)[before..], [load]);
    }

    #[test]
    fn a_change_during_a_recording_or_with_faults_is_reported_and_changes_nothing() {
        let folder = folder("no_reload");
        let larger = TASK.replace("(0,0,1)", "(0,0,10)");
        for (text, is_recording, words) in [
            (&*larger, true, "while a recording runs"),
            ("<tabletop", false, "has changed and is not loaded"),
        ] {
            fs::write(folder.join("task.xml"), TASK).unwrap();
            let app = changed(&folder, text, true, is_recording);
            assert_eq!(commands_of(&app), []);
            let reported = reported(&app);
            assert!(
                reported.len() == 1 && reported[0].contains(words),
                "{reported:?}"
            );
        }
    }

    #[test]
    fn the_setting_is_remembered() {
        let folder = folder("setting");
        ask(&mut app(&folder), FileRequest::Reload(true));
        assert!(app(&folder).world().resource::<Files>().reloads);
    }
}
