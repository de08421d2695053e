//! Recordings as arguments.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::Failure;

/// The recordings in these folders: each of them, or those in it, numbers in their order.
pub(super) fn recordings_in(folders: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let is_recording = |folder: &Path| folder.join("session.jsonl").exists();
    let mut all = Vec::new();
    for folder in folders {
        if is_recording(folder) {
            all.push(folder.clone());
            continue;
        }
        let entries = fs::read_dir(folder)
            .map_err(|error| Failure::input(format!("{}: {error}", folder.display())))?;
        let mut inner: Vec<_> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| is_recording(path))
            .filter(|path| !name_of(path).starts_with('.'))
            .collect();
        if inner.is_empty() {
            return Err(Failure::input(format!(
                "{}: neither a recording nor a folder of recordings",
                folder.display()
            )));
        }
        inner.sort_by_key(|path| {
            let name = name_of(path);
            (name.parse().unwrap_or(u64::MAX), name)
        });
        all.extend(inner);
    }
    Ok(all)
}

fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into()
}
