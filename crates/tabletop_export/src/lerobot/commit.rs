//! Files that become part of a dataset together.

use std::{
    fmt,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use tabletop_storage::{Storage, StoredFile, parent_of};

use crate::error::ExportError;

/// The file that names what a commit consists of, while it is under way.
const JOURNAL: &str = "meta/.commit.json";

/// Largest size of that file, in bytes.
const MOST_JOURNAL_BYTES: u64 = 64 * 1024 * 1024;

/// Files that have hidden names until all of them are whole and on the disk. Then the journal names them, they get their names, and the
/// journal goes. Cut off before the journal is there, nothing has happened; afterwards, the next one to open the dataset goes on.
#[derive(Debug, Default)]
pub(super) struct Commit {
    /// The files, relative to the dataset's folder.
    files: Vec<PathBuf>,
}

/// What a commit that was cut off has left in a dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PendingCommit {
    /// All of so many files are whole, and were about to get their names.
    Named {
        /// Their number.
        files: usize,
    },
    /// So many files are there that are not whole, or have no whole neighbours: nothing of them belongs to the dataset.
    Unnamed {
        /// Their number.
        files: usize,
    },
}

impl fmt::Display for PendingCommit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named { files } => write!(
                f,
                "an export was cut off while it gave {files} whole files their names"
            ),
            Self::Unnamed { files } => write!(
                f,
                "an export was cut off before its {files} files were whole"
            ),
        }
    }
}

impl Commit {
    /// Begins a commit. The last one is completed if it had begun to give names; otherwise its files are removed.
    pub fn begin(folder: &Path, storage: &Storage) -> Result<Self, ExportError> {
        if let Some(begun) = Self::begun(folder, storage)? {
            begun.give_names(folder, storage)?;
        }
        for part in parts_in(folder, storage)? {
            storage.remove_file(&part).map_err(ExportError::io(&part))?;
        }
        Ok(Self::default())
    }

    /// What a commit that was cut off has left, if it has.
    pub fn pending(folder: &Path, storage: &Storage) -> Result<Option<PendingCommit>, ExportError> {
        if let Some(begun) = Self::begun(folder, storage)? {
            let files = begun.files.len();
            return Ok(Some(PendingCommit::Named { files }));
        }
        let files = parts_in(folder, storage)?.len();
        Ok((files > 0).then_some(PendingCommit::Unnamed { files }))
    }

    /// The last commit, if it had begun to give names and was then cut off.
    fn begun(folder: &Path, storage: &Storage) -> Result<Option<Self>, ExportError> {
        let journal = folder.join(JOURNAL);
        let bytes = match storage.read(&journal, MOST_JOURNAL_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if is_missing(&error) => return Ok(None),
            Err(error) => return Err(ExportError::io(&journal)(error)),
        };
        let files: Vec<PathBuf> = serde_json::from_slice(&bytes)
            .map_err(|error| ExportError::dataset(&journal, error))?;
        if let Some(stray) = files.iter().find(|file| !is_inside(file)) {
            let problem = format!("it names {} outside of the dataset", stray.display());
            return Err(ExportError::dataset(&journal, problem));
        }
        Ok(Some(Self { files }))
    }

    /// Begins a file that is to have this path in the dataset. Returns its present path.
    pub fn create(
        &mut self,
        file: &Path,
        folder: &Path,
        storage: &Storage,
    ) -> Result<(PathBuf, StoredFile), ExportError> {
        let part = part_of(&folder.join(file));
        let parent = parent_of(&part);
        storage
            .create_folders(parent)
            .map_err(ExportError::io(parent))?;
        let stored = storage.create(&part).map_err(ExportError::io(&part))?;
        self.files.push(file.to_owned());
        Ok((part, stored))
    }

    /// Adds a whole file.
    pub fn add(
        &mut self,
        file: &Path,
        bytes: &[u8],
        folder: &Path,
        storage: &Storage,
    ) -> Result<(), ExportError> {
        let (part, mut stored) = self.create(file, folder, storage)?;
        let written = stored.append(bytes).and_then(|()| stored.sync());
        written.map_err(ExportError::io(&part))
    }

    /// Gives all files their names.
    pub fn end(self, folder: &Path, storage: &Storage) -> Result<(), ExportError> {
        let journal = folder.join(JOURNAL);
        let text = serde_json::to_vec(&self.files)
            .map_err(|error| ExportError::dataset(&journal, error))?;
        storage
            .replace_name(&journal, &text)
            .map_err(ExportError::io(&journal))?;
        self.give_names(folder, storage)
    }

    fn give_names(&self, folder: &Path, storage: &Storage) -> Result<(), ExportError> {
        for file in &self.files {
            let path = folder.join(file);
            match storage.rename(&part_of(&path), &path) {
                Ok(()) => {}
                // It has its name already.
                Err(error) if error.kind() == ErrorKind::NotFound && path.exists() => {}
                Err(error) => return Err(ExportError::io(&path)(error)),
            }
            let parent = parent_of(&path);
            storage
                .sync_folder(parent)
                .map_err(ExportError::io(parent))?;
        }
        let journal = folder.join(JOURNAL);
        storage
            .remove_file(&journal)
            .map_err(ExportError::io(&journal))
    }
}

/// The hidden name of a file that is not yet part of the dataset.
fn part_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.part"))
}

/// True for a path that stays in the folder that it begins in.
fn is_inside(path: &Path) -> bool {
    path.components()
        .all(|part| matches!(part, std::path::Component::Normal(_)))
}

/// The hidden files of commits in a dataset.
fn parts_in(folder: &Path, storage: &Storage) -> Result<Vec<PathBuf>, ExportError> {
    let mut parts = Vec::new();
    let mut folders = vec![
        folder.join("meta"),
        folder.join("meta/episodes"),
        folder.join("data"),
        folder.join("videos"),
    ];
    while let Some(folder) = folders.pop() {
        let entries = match storage.entries(&folder) {
            Ok(entries) => entries,
            Err(error) if is_missing(&error) => continue,
            Err(error) => return Err(ExportError::io(&folder)(error)),
        };
        for entry in entries {
            let name = entry.file_name().unwrap_or_default().to_string_lossy();
            // Below `videos`, each camera has a folder.
            let is_of_camera = folder.ends_with("videos") && entry.is_dir() && !entry.is_symlink();
            if name.starts_with("chunk-") || is_of_camera {
                folders.push(entry);
            } else if name.starts_with('.') && name.ends_with(".part") {
                parts.push(entry);
            }
        }
    }
    Ok(parts)
}

fn is_missing(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
}
