//! The files that the user can open and save. The owner of the disk keeps [`Files`] and carries out [`FileRequest`]s.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_user::{Action, KeySystems, was_struck};

/// A task file that the user can load.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TaskFile {
    /// Its name in lists.
    pub name: String,
    /// Its place.
    pub path: PathBuf,
}

/// The files that the user can choose from.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Files {
    /// The task files of the working folder.
    pub tasks: Vec<TaskFile>,
    /// Task files and folders of recordings that were opened from elsewhere, the last one first.
    pub recent: Vec<PathBuf>,
    /// True if the task file on the table is loaded anew when it changes on the disk.
    pub reloads: bool,
}

/// Something that the user wants to be done with files.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// List the task files of the working folder anew.
    ListTasks,
    /// Ask for a task file or a recording, and open it.
    AskToOpen,
    /// Ask for a task file, and save the present state as it.
    AskToSave,
    /// Ask for the file of a video of the recording that the Timeline shows, and save it.
    AskForVideo,
    /// Ask for the file of a picture of the view, of so many columns and rows, and save it.
    AskForPicture([u32; 2]),
    /// Ask for the file of a table of the curves that Plots shows, and save it.
    AskForTable,
    /// Ask for the file of a picture of the plot, and save it.
    AskForPlot,
    /// Open a task file or a recording, which may be named by its folder or a file in it.
    Open(PathBuf),
    /// Save the present state as a task file. If there is a file, the user has agreed to its end.
    Save(PathBuf),
    /// Save a video of the recording that the Timeline shows; the end of the name gives the format.
    SaveVideo(PathBuf),
    /// Save a picture of the view, of so many columns and rows.
    SavePicture(PathBuf, [u32; 2]),
    /// Save the curves that Plots shows as a table.
    SaveTable(PathBuf),
    /// Save a picture of the plot.
    SavePlot(PathBuf),
    /// Load the task file on the table anew, or not, when it changes on the disk.
    Reload(bool),
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Files>()
        .add_message::<FileRequest>()
        .add_systems(
            RunFixedMainLoop,
            (
                (|mut requests: MessageWriter<FileRequest>| {
                    requests.write(FileRequest::AskToOpen);
                })
                .run_if(was_struck(Action::OpenFile)),
                (|mut requests: MessageWriter<FileRequest>| {
                    requests.write(FileRequest::AskToSave);
                })
                .run_if(was_struck(Action::SaveFile)),
            )
                .in_set(KeySystems),
        );
}

/// The last part of a path, as the user reads it.
pub(crate) fn short_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use KeyCode::{ControlLeft, KeyO, KeyS};

    #[test]
    fn keys_ask_for_files() {
        for (key, request) in [
            (KeyO, FileRequest::AskToOpen),
            (KeyS, FileRequest::AskToSave),
        ] {
            let mut test = TestWorld::new(plugin);
            let mut keys = test.app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.press(ControlLeft);
            keys.press(key);
            test.app.update();
            let requests = test.app.world().resource::<Messages<FileRequest>>();
            let requests: Vec<_> = requests.iter_current_update_messages().collect();
            assert_eq!(requests, [&request]);
        }
    }
}
