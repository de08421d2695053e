//! The content of a folder, as far as it can be opened.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::files::short_name;

/// The entries of a folder that can be chosen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct FolderContent {
    pub path: PathBuf,
    pub entries: Vec<FileEntry>,
    /// The reason why there are no entries.
    pub problem: Option<String>,
}

/// Something in a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FileEntry {
    pub kind: EntryKind,
    pub name: String,
}

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum EntryKind {
    Folder,
    Recording,
    Task,
}

impl FolderContent {
    /// Reads a folder.
    pub fn read(path: &Path) -> Self {
        let path = std::path::absolute(path).unwrap_or(path.to_owned());
        match list(&path) {
            Ok(entries) => Self {
                path,
                entries,
                problem: None,
            },
            Err(error) => Self {
                problem: Some(format!("{} cannot be read: {error}", short_name(&path))),
                path,
                entries: Vec::new(),
            },
        }
    }
}

/// Folders, then recordings, then task files, each by name; without hidden ones.
fn list(folder: &Path) -> io::Result<Vec<FileEntry>> {
    let found = fs::read_dir(folder)?;
    let mut entries: Vec<_> = found
        .flatten()
        .filter_map(|found| entry(&found.path()))
        .collect();
    entries.sort();
    Ok(entries)
}

fn entry(path: &Path) -> Option<FileEntry> {
    let name = short_name(path);
    let is_task = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("xml"));
    let kind = if path.is_dir() {
        match path.join("session.jsonl").is_file() {
            true => EntryKind::Recording,
            false => EntryKind::Folder,
        }
    } else {
        is_task.then_some(EntryKind::Task)?
    };
    (!name.starts_with('.')).then_some(FileEntry { kind, name })
}
