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

/// Its name until it is locked.
const UNLOCKED: &str = ".tabletop-lock.new";

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
        match create_locked(&path, storage) {
            Ok(lock) => Ok(Self {
                path,
                storage: storage.clone(),
                lock,
            }),
            Err(error) => {
                let _not_there = storage.remove_file(&path.join(UNLOCKED));
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
        // Held until nobody finds it any more.
        storage.remove_file(&path.join(LOCK))?;
        drop(lock);
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
        remove_locked(&path, lock, &storage)
    }
}

/// Makes the lock. Under its name, it is locked from the beginning, so that nobody takes the folder for abandoned.
fn create_locked(folder: &Path, storage: &Storage) -> io::Result<StoredFile> {
    let unlocked = folder.join(UNLOCKED);
    let lock = storage.create(&unlocked)?;
    // A file system without locks is no obstacle: then nobody removes the folder.
    let _has_locks = lock.is_locked_now();
    storage.rename(&unlocked, &folder.join(LOCK))?;
    Ok(lock)
}

/// Removes a folder of which this is the lock.
fn remove_locked(folder: &Path, lock: StoredFile, storage: &Storage) -> io::Result<()> {
    remove_around_lock(folder, storage)?;
    storage.remove_file(&folder.join(LOCK))?;
    drop(lock);
    storage.remove_empty(folder)
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
        if is_of_this_kind
            && !entry.is_symlink()
            && entry.is_dir()
            && let Some(lock) = lock_if_abandoned(&entry, storage)
        {
            // Another user's, or a disk that fails: it stays.
            let _stays = remove_locked(&entry, lock, storage);
        }
    }
}

/// The lock of a folder, locked, if nobody else holds it.
fn lock_if_abandoned(folder: &Path, storage: &Storage) -> Option<StoredFile> {
    let path = folder.join(LOCK);
    let lock = storage.open_to_read(&path).ok()?;
    // Meanwhile, another program may have removed the folder, and a third one may have made one of this name.
    let is_abandoned = lock.is_locked_now() && lock.is_at(&path).unwrap_or(false);
    is_abandoned.then_some(lock)
}
