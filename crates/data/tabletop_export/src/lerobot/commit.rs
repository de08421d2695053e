//! Files that become part of a dataset together.

use std::{
    fmt,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use tabletop_storage::{
    InnerFile, InnerPath, Storage, StoredFile, is_taken, parent_of, require_no_links,
};

use super::{episode_table::first_episode, info::Info};
use crate::error::ExportError;

/// The file that names what a commit consists of, while it is under way.
const JOURNAL: &str = "meta/.commit.json";

/// Largest size of that file, in bytes.
const MOST_JOURNAL_BYTES: u64 = 64 * 1024 * 1024;

/// Files that have hidden names until all of them are whole and on the disk. Then the journal names them, they get their names, and the
/// journal goes. Given up before the journal is there, they are removed; afterwards, the next one to open the dataset goes on.
#[derive(Debug)]
pub(super) struct Commit {
    /// The dataset's.
    folder: PathBuf,
    storage: Storage,
    /// The files, relative to the folder.
    files: Vec<InnerPath>,
    /// True once the journal may name them.
    is_promised: bool,
}

/// What a commit that was cut off has left in a dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PendingCommit {
    /// All of so many files are whole, and were about to get their names.
    Named {
        /// Their number.
        files: usize,
    },
    /// Some of its files are gone, so that it cannot be ended.
    Broken {
        /// Their number.
        gone: usize,
        /// That of all its files.
        files: usize,
    },
    /// The list of its files is none that an export writes: only what has no name yet can be taken back.
    Damaged,
    /// So many files are there that are not whole, or have no whole neighbours: nothing of them belongs to the dataset.
    Unnamed {
        /// Their number.
        files: usize,
    },
}

/// A commit that was cut off.
enum Begun {
    Nothing,
    Commit(Commit),
    /// Its journal cannot be understood.
    Damaged,
}

impl fmt::Display for PendingCommit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named { files } => write!(
                f,
                "an export was cut off while it gave {files} whole files their names"
            ),
            Self::Broken { gone, files } => write!(
                f,
                "an export was cut off while it gave {files} files their names, and {gone} of them are gone"
            ),
            Self::Damaged => write!(
                f,
                "an export was cut off while it gave files their names, and {JOURNAL} is damaged"
            ),
            Self::Unnamed { files } => write!(
                f,
                "an export was cut off before its {files} files were whole"
            ),
        }
    }
}

impl Commit {
    /// Begins a commit. The last one is completed if it had begun to give names and has all its files; otherwise they are removed.
    pub fn begin(folder: &Path, storage: &Storage) -> Result<Self, ExportError> {
        match Self::begun(folder, storage)? {
            Begun::Commit(begun) if begun.gone() == 0 => begun.give_names()?,
            Begun::Commit(begun) => begun.take_back()?,
            Begun::Damaged => Self::of(folder, storage, Vec::new(), true).take_back()?,
            Begun::Nothing => remove_parts(folder, storage)?,
        }
        Ok(Self::of(folder, storage, Vec::new(), false))
    }

    fn of(folder: &Path, storage: &Storage, files: Vec<InnerPath>, is_promised: bool) -> Self {
        Self {
            folder: folder.to_owned(),
            storage: storage.clone(),
            files,
            is_promised,
        }
    }

    /// What a commit that was cut off has left, if it has.
    pub fn pending(folder: &Path, storage: &Storage) -> Result<Option<PendingCommit>, ExportError> {
        Ok(match Self::begun(folder, storage)? {
            Begun::Commit(begun) => {
                let (files, gone) = (begun.files.len(), begun.gone());
                Some(match gone {
                    0 => PendingCommit::Named { files },
                    _ => PendingCommit::Broken { gone, files },
                })
            }
            Begun::Damaged => Some(PendingCommit::Damaged),
            Begun::Nothing => {
                let files = parts_in(folder, storage)?.len();
                (files > 0).then_some(PendingCommit::Unnamed { files })
            }
        })
    }

    /// The last commit, if it had begun to give names and was then cut off.
    fn begun(folder: &Path, storage: &Storage) -> Result<Begun, ExportError> {
        let journal = folder.join(JOURNAL);
        let bytes = match storage.read(&journal, MOST_JOURNAL_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if is_missing(&error) => return Ok(Begun::Nothing),
            Err(error) => return Err(ExportError::io(&journal)(error)),
        };
        let files = serde_json::from_slice::<Vec<String>>(&bytes).ok();
        let files = files.and_then(|files| {
            let files = files.into_iter().map(InnerPath::new);
            files.collect::<Result<_, _>>().ok()
        });
        Ok(files.map_or(Begun::Damaged, |files| {
            Begun::Commit(Self::of(folder, storage, files, true))
        }))
    }

    /// Begins a file that is to have this path in the dataset. Returns its present path.
    pub fn create(&mut self, file: &InnerPath) -> Result<(PathBuf, StoredFile), ExportError> {
        let part = part_of(&self.path_of(file)?);
        let parent = parent_of(&part);
        self.storage
            .create_folders(parent)
            .map_err(ExportError::io(parent))?;
        self.files.push(file.to_owned());
        let stored = self.storage.create(&part);
        Ok((part.clone(), stored.map_err(ExportError::io(&part))?))
    }

    /// Adds a whole file.
    pub fn add(&mut self, file: &InnerPath, bytes: &[u8]) -> Result<(), ExportError> {
        let (part, mut stored) = self.create(file)?;
        let written = stored.append(bytes).and_then(|()| stored.sync());
        written.map_err(ExportError::io(&part))
    }

    /// Gives all files their names.
    pub fn end(mut self) -> Result<(), ExportError> {
        if let Some(gone) = self.parts().find(|part| !is_taken(part)) {
            return Err(ExportError::dataset(
                &gone,
                "somebody has removed it during the export, of which nothing is added",
            ));
        }
        let journal = self.folder.join(JOURNAL);
        let files: Vec<_> = self.files.iter().map(InnerPath::as_path).collect();
        let text =
            serde_json::to_vec(&files).map_err(|error| ExportError::dataset(&journal, error))?;
        let written = self.storage.replace_name(&journal, &text);
        self.is_promised = is_taken(&journal);
        written.map_err(ExportError::io(&journal))?;
        self.give_names()
    }

    fn give_names(&self) -> Result<(), ExportError> {
        for file in &self.files {
            let path = self.path_of(file)?;
            match self.storage.rename(&part_of(&path), &path) {
                Ok(()) => {}
                // It has its name already.
                Err(error) if error.kind() == ErrorKind::NotFound && is_taken(&path) => {}
                Err(error) => return Err(ExportError::io(&path)(error)),
            }
            let parent = parent_of(&path);
            self.storage
                .sync_folder(parent)
                .map_err(ExportError::io(parent))?;
        }
        remove(&self.folder.join(JOURNAL), &self.storage)
    }

    /// The path of a file of the dataset, to be given to it. No folder on the way is a link.
    fn path_of(&self, file: &InnerPath) -> Result<PathBuf, ExportError> {
        let inner = file.folder();
        let checked = inner.map(|inner| require_no_links(&self.folder, &inner));
        checked.transpose().map_err(ExportError::io(&self.folder))?;
        Ok(file.below(&self.folder))
    }

    /// The hidden names of its files.
    fn parts(&self) -> impl Iterator<Item = PathBuf> {
        let paths = self.files.iter().map(|file| file.below(&self.folder));
        paths.map(|path| part_of(&path))
    }

    /// Number of files that have neither their name nor a hidden one.
    fn gone(&self) -> usize {
        let is_gone = |path: &PathBuf| !is_taken(path) && !is_taken(&part_of(path));
        let paths = self.files.iter().map(|file| file.below(&self.folder));
        paths.filter(is_gone).count()
    }

    /// Removes what it has added: its hidden files, and those that have names but no episode that the dataset counts.
    fn take_back(&self) -> Result<(), ExportError> {
        let counted = Info::read(&self.folder)?.map_or(0, |info| info.total_episodes);
        let is_there = |file: &&InnerPath| is_taken(&file.below(&self.folder));
        let remove_file = |file: &InnerPath| remove(&self.path_of(file)?, &self.storage);
        let (tables, others): (Vec<_>, Vec<_>) = self.files.iter().partition(|file| is_table(file));
        for table in tables.iter().filter(|file| is_there(file)) {
            let first = first_episode(&InnerFile::new(&self.folder, (*table).clone()));
            if first.is_none_or(|first| first >= counted) {
                remove_file(table)?;
            }
        }
        if !tables.iter().any(is_there) {
            let videos = others
                .iter()
                .filter(|file| file.as_path().starts_with("videos"));
            for video in videos.filter(|file| is_there(file)) {
                remove_file(video)?;
            }
        }
        remove_parts(&self.folder, &self.storage)?;
        remove(&self.folder.join(JOURNAL), &self.storage)
    }
}

impl Drop for Commit {
    /// Removes the files of a commit that is given up, as far as it can. The next one finds those that remain.
    fn drop(&mut self) {
        if !self.is_promised {
            for part in self.parts() {
                let _remains = self.storage.remove_file(&part);
            }
        }
    }
}

fn remove(path: &Path, storage: &Storage) -> Result<(), ExportError> {
    storage.remove_file(path).map_err(ExportError::io(path))
}

fn remove_parts(folder: &Path, storage: &Storage) -> Result<(), ExportError> {
    let parts = parts_in(folder, storage)?;
    parts.iter().try_for_each(|part| remove(part, storage))
}

/// True for a file of episodes' frames, or of rows about episodes.
fn is_table(file: &InnerPath) -> bool {
    let file = file.as_path();
    file.starts_with("data") || file.starts_with("meta/episodes")
}

/// The hidden name of a file that is not yet part of the dataset.
fn part_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.part"))
}

/// The hidden files of commits in a dataset.
fn parts_in(folder: &Path, storage: &Storage) -> Result<Vec<PathBuf>, ExportError> {
    let mut parts = Vec::new();
    let outermost = ["meta", "meta/episodes", "data", "videos"].map(InnerPath::fixed);
    for inner in &outermost {
        require_no_links(folder, inner).map_err(ExportError::io(folder))?;
    }
    let mut folders: Vec<_> = outermost.iter().map(|inner| inner.below(folder)).collect();
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
            if name.starts_with("chunk-") && entry.is_symlink() {
                let problem =
                    "it is a link, which could lead anywhere; put what it leads to in its place";
                return Err(ExportError::dataset(entry, problem));
            } else if name.starts_with("chunk-") || is_of_camera {
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
