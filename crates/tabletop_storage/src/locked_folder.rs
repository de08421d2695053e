//! Folders that show by a lock that their program runs.

use std::{
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process,
};

use crate::{
    path::{hidden_prefix, parent_of},
    storage::Storage,
    stored_file::StoredFile,
};

/// The file in the folder that is locked as long as the program runs.
const LOCK: &str = ".tabletop-lock";

/// Number of names that are tried.
const NAMES: u32 = 1000;

/// A folder with a number in its name, and a file in it that is locked as long as its program runs. Who makes the next one removes those
/// of killed programs: folders of such a name in which nobody holds the lock.
#[derive(Debug)]
pub struct LockedFolder {
    path: PathBuf,
    storage: Storage,
    lock: StoredFile,
}

impl LockedFolder {
    /// Makes a folder under a hidden name beside a place, `.NAME.new-NUMBER`, to be filled there.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn beside(place: &Path, storage: &Storage) -> io::Result<Self> {
        Self::create(parent_of(place), &hidden_prefix(place), storage)
    }

    /// Makes a folder in another, with this prefix before the number in its name.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn create(parent: &Path, prefix: &str, storage: &Storage) -> io::Result<Self> {
        remove_abandoned(parent, prefix, storage);
        let path = create_numbered(parent, prefix, storage)?;
        match storage.create(&path.join(LOCK)) {
            Ok(lock) => {
                // A file system without locks is no obstacle: then nobody removes it.
                let _has_locks = lock.is_locked_now();
                Ok(Self {
                    path,
                    storage: storage.clone(),
                    lock,
                })
            }
            Err(error) => {
                let _stays_empty = storage.remove_empty(&path);
                Err(error)
            }
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the lock: the folder is complete, and nobody removes it any more. Returns its path.
    ///
    /// # Errors
    /// The lock cannot be removed.
    pub fn unlock(self) -> io::Result<PathBuf> {
        let Self {
            path,
            storage,
            lock,
        } = self;
        drop(lock);
        storage.remove_file(&path.join(LOCK))?;
        Ok(path)
    }

    /// Removes it with all that is in it.
    ///
    /// # Errors
    /// A part of it cannot be removed.
    pub fn remove(self) -> io::Result<()> {
        let Self {
            path,
            storage,
            lock,
        } = self;
        remove_around_lock(&path, &storage)?;
        drop(lock);
        remove_lock(&path, &storage)
    }
}

/// Removes all but the lock, which goes last: until then, the next program can go on.
fn remove_around_lock(folder: &Path, storage: &Storage) -> io::Result<()> {
    let lock = folder.join(LOCK);
    let entries = storage.entries(folder)?.into_iter();
    for entry in entries.filter(|entry| *entry != lock) {
        match entry.symlink_metadata()?.is_dir() {
            true => storage.remove_folder(&entry)?,
            false => storage.remove_file(&entry)?,
        }
    }
    Ok(())
}

fn remove_lock(folder: &Path, storage: &Storage) -> io::Result<()> {
    storage.remove_file(&folder.join(LOCK))?;
    storage.remove_empty(folder)
}

fn create_numbered(parent: &Path, prefix: &str, storage: &Storage) -> io::Result<PathBuf> {
    let first = process::id();
    for number in first..first.saturating_add(NAMES) {
        let path = parent.join(format!("{prefix}{number}"));
        match storage.create_folder(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => {
                let reason = format!("{}: {error}", path.display());
                return Err(io::Error::new(error.kind(), reason));
            }
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

/// Removes the folders of this kind whose programs do not run any more.
fn remove_abandoned(parent: &Path, prefix: &str, storage: &Storage) {
    for entry in storage.entries(parent).unwrap_or_default() {
        let name = entry.file_name().unwrap_or_default().to_string_lossy();
        let number = name.strip_prefix(prefix);
        let is_of_this_kind = number.is_some_and(|number| number.parse::<u32>().is_ok());
        if is_of_this_kind && !entry.is_symlink() && entry.is_dir() && is_abandoned(&entry, storage)
        {
            // Another user's, or a disk that fails: it stays.
            let _stays =
                remove_around_lock(&entry, storage).and_then(|()| remove_lock(&entry, storage));
        }
    }
}

/// True if a folder's lock exists and nobody holds it.
fn is_abandoned(folder: &Path, storage: &Storage) -> bool {
    let lock = storage.open_to_read(&folder.join(LOCK));
    lock.is_ok_and(|lock| lock.is_locked_now())
}
