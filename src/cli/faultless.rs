//! Task files that must have no faults.

use std::path::{Path, PathBuf};

use tabletop::{core::SceneSpec, shipped::task_reader};

<<<<<<< HEAD
/// The scene of a task file, or all its faults.
pub(super) fn read_faultless_task(file: &Path) -> Result<SceneSpec, String> {
    faultless(read_task(file))
}

/// The scene of a task file that was read, or all its faults.
pub(super) fn faultless(task: Result<ParsedTask, ReadError>) -> Result<SceneSpec, String> {
=======
/// The scene of a task file, which may include files in the folders that are allowed, or everything that is wrong with it.
pub(super) fn read_faultless_task(file: &Path, allowed: &[PathBuf]) -> Result<SceneSpec, String> {
    let task = task_reader().allowing(allowed).read(file);
>>>>>>> 07415a0 (Keep meshes of a recording's robot within reach of the recording)
    let task = task.map_err(|error| error.to_string())?;
    let faults: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    match faults.is_empty() {
        true => Ok(task.scene),
        false => Err(faults.join("\n")),
    }
}
