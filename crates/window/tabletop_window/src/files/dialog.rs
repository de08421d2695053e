//! File dialogs: those of the desktop, or the program's own list where the desktop has none.

use std::{
    env,
    ffi::OsString,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::{
    prelude::*,
    tasks::{IoTaskPool, Task, futures::check_ready},
};
use rfd::{AsyncFileDialog, FileHandle};
use tabletop_gui::{Browser, FileRequest, Purpose};

use tabletop_sim::task_files::TASK_FOLDER;

/// Duration below which a dialog without a choice was never seen: the desktop could not show it.
const SHORTEST: Duration = Duration::from_millis(300);

/// The dialog that is open.
#[derive(Resource, Default)]
pub(super) struct Dialog(Option<OpenDialog>);

struct OpenDialog {
    purpose: Purpose,
    since: Instant,
    answer: Task<Option<PathBuf>>,
}

/// Asks for a file, unless the user is being asked already.
pub(super) fn ask(world: &mut World, purpose: Purpose) {
    if world.resource::<Dialog>().0.is_some() {
        return;
    }
    if has_dialogs(|name| env::var_os(name)) {
        let answer = IoTaskPool::get().spawn(show(purpose));
        world.resource_mut::<Dialog>().0 = Some(OpenDialog {
            purpose,
            since: Instant::now(),
            answer,
        });
    } else {
        world
            .resource_mut::<Browser>()
            .ask(purpose, &first_folder());
    }
}

/// Takes the user's choice in the desktop's dialog.
pub(super) fn take_answer(
    mut dialog: ResMut<Dialog>,
    mut browser: ResMut<Browser>,
    mut requests: MessageWriter<FileRequest>,
) {
    let Some(open) = &mut dialog.bypass_change_detection().0 else {
        return;
    };
    let Some(answer) = check_ready(&mut open.answer) else {
        return;
    };
    let (purpose, lasted) = (open.purpose, open.since.elapsed());
    dialog.0 = None;
    match (answer, purpose) {
        (Some(path), purpose) => {
            requests.write(purpose.request(path));
        }
        (None, _) if lasted < SHORTEST => browser.ask(purpose, &first_folder()),
        (None, _) => {}
    }
}

fn show(purpose: Purpose) -> impl Future<Output = Option<PathBuf>> + Send + 'static {
    let dialog = AsyncFileDialog::new().set_directory(first_folder());
    async move {
        let dialog = dialog.set_title(purpose.title());
        let chosen = match purpose {
            Purpose::Open => {
                let dialog = dialog
                    .add_filter("Task files, recordings", &["xml", "jsonl"])
                    .add_filter("All files", &["*"]);
                dialog.pick_file().await
            }
            Purpose::Save
            | Purpose::Video
            | Purpose::Picture(_)
            | Purpose::Table
            | Purpose::Plot => {
                let (kind, extensions): (_, &[_]) = match purpose {
                    Purpose::Video => {
                        ("Videos, animations, contact sheets", &["mp4", "gif", "png"])
                    }
                    Purpose::Picture(_) | Purpose::Plot => ("Pictures", &["png"]),
                    Purpose::Table => ("Tables", &["csv"]),
                    Purpose::Open | Purpose::Save => ("Task files", &["xml"]),
                };
                let dialog = dialog.add_filter(kind, extensions);
                dialog.set_file_name(purpose.file_name()).save_file().await
            }
        };
        chosen.map(|file: FileHandle| file.path().to_owned())
    }
}

/// The folder of the task files, or the working folder.
fn first_folder() -> PathBuf {
    let tasks = Path::new(TASK_FOLDER);
    let folder = if tasks.is_dir() {
        tasks
    } else {
        Path::new(".")
    };
    std::path::absolute(folder).unwrap_or(folder.to_owned())
}

/// True if there is a desktop that has dialogs: on Linux, a session with a portal, or Zenity.
fn has_dialogs(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let folders = |name: &str, usual: &str| {
        let value = variable(name).filter(|value| !value.is_empty());
        let value = value.unwrap_or_else(|| usual.into());
        env::split_paths(&value).collect::<Vec<_>>()
    };
    let has_bus = variable("DBUS_SESSION_BUS_ADDRESS").is_some_and(|bus| !bus.is_empty())
        || folders("XDG_RUNTIME_DIR", "/nowhere")
            .iter()
            .any(|folder| folder.join("bus").exists());
    let service = "dbus-1/services/org.freedesktop.portal.Desktop.service";
    let has_portal = folders("XDG_DATA_DIRS", "/usr/local/share:/usr/share")
        .iter()
        .any(|folder| folder.join(service).is_file());
    let is_in_sandbox = Path::new("/.flatpak-info").exists();
    let has_zenity = folders("PATH", "")
        .iter()
        .any(|folder| folder.join("zenity").is_file());
    has_bus && (has_portal || is_in_sandbox) || has_zenity
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_folder::TestFolder;

    #[test]
    fn dialogs_need_a_session_with_a_portal_or_zenity() {
        let folder = TestFolder::new("dialogs");
        for file in [
            "run/bus",
            "share/dbus-1/services/org.freedesktop.portal.Desktop.service",
            "bin/zenity",
            "empty/nothing",
        ] {
            folder.write(file, "");
        }
        let has = |bus: Option<&str>, run: &str, share: &str, bin: &str| {
            has_dialogs(|name| match name {
                "DBUS_SESSION_BUS_ADDRESS" => bus.map(OsString::from),
                "XDG_RUNTIME_DIR" => Some(folder.join(run).into()),
                "XDG_DATA_DIRS" => Some(folder.join(share).into()),
                "PATH" => Some(folder.join(bin).into()),
                _ => None,
            })
        };
        assert!(has(None, "run", "share", "empty"));
        assert!(has(Some("unix:path=/bus"), "empty", "share", "empty"));
        assert!(has(None, "empty", "empty", "bin"));
        assert!(!has(None, "empty", "share", "empty"));
        assert!(!has(Some("unix:path=/bus"), "run", "empty", "empty"));
        assert!(!has(Some(""), "empty", "share", "empty"));
    }
}
