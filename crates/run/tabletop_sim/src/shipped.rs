//! Files inside the program, so that it can be started in any folder: task files, scenarios, scripts and robots.
//!
//! If a path of the command line, a scenario or [`SceneCommand::Load`](tabletop_core::SceneCommand::Load) leads to nothing,
//! the file of the same path is taken from here. Its name, such as `shipped:tablesetup/default.xml`, always means it.

use std::{
    io,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use bevy::prelude::*;
use include_dir::{Dir, include_dir};
use tabletop_core::{SceneSpec, ShippedFile, ShippedFiles};
use tabletop_scenario::{Scenario, ScenarioError};
use tabletop_storage::{Symlinks, read_regular_text};
use tabletop_xml::{ParsedTask, ReadError, TaskReader};

/// The folders of a working folder.
pub const WORKING_FOLDERS: [&str; 6] = [
    "tablesetup",
    "matlab",
    "scenarios",
    "python",
    "learners",
    ROBOT_FOLDER,
];

/// That of robots, which holds other files, too.
pub(crate) const ROBOT_FOLDER: &str = "assets";

/// The contents of those that hold nothing else.
static CONTENTS: [(&str, Dir); 4] = [
    (
        "tablesetup",
        include_dir!("$CARGO_MANIFEST_DIR/../../../tablesetup"),
    ),
    (
        "matlab",
        include_dir!("$CARGO_MANIFEST_DIR/../../../matlab"),
    ),
    (
        "scenarios",
        include_dir!("$CARGO_MANIFEST_DIR/../../../scenarios"),
    ),
    (
        "learners",
        include_dir!("$CARGO_MANIFEST_DIR/../../../learners"),
    ),
];

/// The endings of their files; other files that a script may have left there are not shipped.
const ENDINGS: [&str; 6] = ["xml", "xsd", "stl", "m", "ron", "py"];

macro_rules! script {
    ($name:literal) => {
        ShippedFile {
            path: concat!("python/", $name),
            text: include_str!(concat!("../../../../python/", $name)),
        }
    };
}

/// The scripts in the folder of the Python package.
const SCRIPTS: [ShippedFile; 3] = [
    script!("example.py"),
    script!("tabletop_driver.py"),
    script!("wave.py"),
];

macro_rules! asset {
    ($path:literal) => {
        ShippedFile {
            path: concat!("assets/", $path),
            text: include_str!(concat!("../../../../assets/", $path)),
        }
    };
}

/// The descriptions of robots; the program knows the files that they name.
const ROBOTS: [ShippedFile; 7] = [
    asset!("baxter/baxter.urdf"),
    asset!("baxter/robot.ron"),
    asset!("panda/panda.urdf"),
    asset!("panda/robot.ron"),
    asset!("so101/so101.urdf"),
    asset!("so101/robot.ron"),
    asset!("baxter/baxter_smile.urdf"),
];

/// All files that are inside the program.
pub fn shipped_files() -> &'static ShippedFiles {
    static FILES: LazyLock<ShippedFiles> = LazyLock::new(|| {
        let files = CONTENTS.iter().flat_map(|(folder, contents)| {
            contents.files().filter_map(move |file| {
                let name = file.path().to_str()?;
                let ending = file.path().extension()?.to_str()?;
                ENDINGS.contains(&ending).then_some(ShippedFile {
                    // Made once, and needed until the end.
                    path: format!("{folder}/{name}").leak(),
                    text: file.contents_utf8()?,
                })
            })
        });
        ShippedFiles::new(files.chain(SCRIPTS).chain(ROBOTS))
    });
    &FILES
}

/// Lets [`SceneCommand::Load`](tabletop_core::SceneCommand::Load) find the files inside the program.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShippedFilesPlugin;

impl Plugin for ShippedFilesPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(shipped_files().clone());
    }
}

/// Reads a task file, from the folder or the program.
///
/// # Errors
///
/// It is in neither, or cannot be read.
pub fn read_task(path: &Path) -> Result<ParsedTask, ReadError> {
    task_reader().read(path)
}

/// The scene of a task file, from the folder or the program, which may include files in the allowed folders.
///
/// # Errors
///
/// It is in neither, cannot be read, or has faults, which are listed.
pub fn read_faultless_task(file: &Path, allowed: &[PathBuf]) -> Result<SceneSpec, String> {
    let task = task_reader().allowing(allowed).read(file);
    let task = task.map_err(|error| error.to_string())?;
    let faults: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    match faults.is_empty() {
        true => Ok(task.scene),
        false => Err(faults.join("\n")),
    }
}

/// Reads task files, from the folder or the program.
pub fn task_reader() -> TaskReader<'static> {
    TaskReader::with_shipped(shipped_files())
}

/// Reads a scenario, from the folder or the program. The task files that a shipped one names are shipped ones.
///
/// # Errors
///
/// It is in neither, cannot be read, or has a fault.
pub fn read_scenario(path: &Path) -> Result<Scenario, ScenarioError> {
    match shipped_files().find(path) {
        Some(file) => Scenario::parse(file.name(), file.text),
        None => Scenario::read(path).map_err(|error| match error {
            ScenarioError::Unreadable { path, reason } => ScenarioError::Unreadable {
                reason: reason + &shipped_files().way_on(&path, &["scenarios", "tablesetup"]),
                path,
            },
            error @ (ScenarioError::Syntax { .. }
            | ScenarioError::Step { .. }
            | ScenarioError::Setup { .. }
            | ScenarioError::Failed { .. }
            | ScenarioError::Several(_)) => error,
        }),
    }
}

/// Size of the largest text that is read from disk.
const MOST_BYTES: u64 = 16 << 20;

/// Reads any text, from the folder or the program.
///
/// # Errors
///
/// It is in neither, or cannot be read.
pub fn read_text(path: &Path) -> io::Result<String> {
    match shipped_files().find(path) {
        Some(file) => Ok(file.text.to_owned()),
        None => read_regular_text(path, MOST_BYTES, Symlinks::Followed),
    }
}

/// The path that means the same file in any working folder.
pub fn true_path(path: &Path) -> PathBuf {
    match shipped_files().find(path) {
        Some(file) => file.name(),
        None => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
    }

    #[test]
    fn every_file_of_the_working_folders_is_shipped_as_it_is() {
        let root = root();
        for folder in WORKING_FOLDERS {
            if folder == ROBOT_FOLDER {
                continue;
            }
            let mut paths: Vec<_> = fs::read_dir(root.join(folder))
                .unwrap()
                .map(|entry| Path::new(folder).join(entry.unwrap().file_name()))
                .filter(|path| {
                    let ending = path.extension().and_then(|ending| ending.to_str());
                    ending.is_some_and(|ending| ENDINGS.contains(&ending))
                })
                .collect();
            paths.sort();
            let shipped: Vec<_> = shipped_files().in_folder(folder).collect();
            let listed: Vec<_> = shipped.iter().map(|file| Path::new(file.path)).collect();
            assert_eq!(
                listed, paths,
                "touch crates/run/tabletop_sim/src/shipped.rs after a new file"
            );
            for file in shipped {
                assert_eq!(
                    fs::read_to_string(root.join(file.path)).unwrap(),
                    file.text,
                    "{}",
                    file.path
                );
            }
        }
    }

    #[test]
    fn every_shipped_scenario_and_task_file_is_read_where_there_are_none() {
        for file in shipped_files().in_folder("tablesetup") {
            if file.path.ends_with(".xml") {
                let task = read_task(&file.name()).unwrap();
                assert_eq!(task.faults, [], "{}", file.path);
            }
        }
        for file in shipped_files().in_folder("scenarios") {
            let scenario = read_scenario(&file.name()).unwrap();
            let program = tabletop_scenario::Program::new(
                &scenario,
                |path| {
                    assert!(tabletop_core::is_shipped(path), "{}", path.display());
                    let task = read_task(path).map_err(|error| error.to_string())?;
                    Ok(task.scene)
                },
                0,
            );
            program.unwrap_or_else(|error| panic!("{error}"));
        }
    }

    #[test]
    fn true_paths_stay_unchanged() {
        let path = root().join("tablesetup/default.xml");
        assert_eq!(true_path(&path), path);
        let shipped = Path::new("shipped:tablesetup/default.xml");
        assert_eq!(true_path(shipped), shipped);
        let missing = Path::new("tablesetup/missing.xml");
        assert_eq!(true_path(missing), missing);
    }
}
