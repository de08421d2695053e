//! Task files that must have no faults.

use std::path::{Path, PathBuf};

use crate::{core::SceneSpec, shipped::task_reader};

/// The scene of a task file, which may include files in the allowed folders, or all its faults.
pub(super) fn read_faultless_task(file: &Path, allowed: &[PathBuf]) -> Result<SceneSpec, String> {
    let task = task_reader().allowing(allowed).read(file);
    let task = task.map_err(|error| error.to_string())?;
    let faults: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    match faults.is_empty() {
        true => Ok(task.scene),
        false => Err(faults.join("\n")),
    }
}
