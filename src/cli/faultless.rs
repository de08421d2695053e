//! Task files that must have no faults.

use std::path::Path;

use tabletop::{
    core::SceneSpec,
    shipped::read_task,
    xml::{ParsedTask, ReadError},
};

/// The scene of a task file, or all its faults.
pub(super) fn read_faultless_task(file: &Path) -> Result<SceneSpec, String> {
    faultless(read_task(file))
}

/// The scene of a task file that was read, or all its faults.
pub(super) fn faultless(task: Result<ParsedTask, ReadError>) -> Result<SceneSpec, String> {
    let task = task.map_err(|error| error.to_string())?;
    let faults: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    match faults.is_empty() {
        true => Ok(task.scene),
        false => Err(faults.join("\n")),
    }
}
