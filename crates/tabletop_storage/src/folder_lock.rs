//! Locks on folders, for moments in which nobody else may change their contents.

use std::{
    fs::{File, TryLockError},
    path::Path,
    thread::sleep,
    time::Duration,
};

use crate::storage::Storage;

const ATTEMPTS: u32 = 200;
const BETWEEN_ATTEMPTS: Duration = Duration::from_millis(10);

/// Keeps other programs that ask for it from a folder, as long as it is there.
#[derive(Debug)]
pub struct FolderLock {
    _locked: File,
}

impl FolderLock {
    /// Waits for others; not for long, and not where the file system knows no locks or the system opens no folders.
    pub fn wait(folder: &Path, storage: &Storage) -> Option<Self> {
        let locked = storage.open_folder(folder).ok()?;
        for _ in 0..ATTEMPTS {
            match locked.try_lock() {
                Ok(()) => return Some(Self { _locked: locked }),
                Err(TryLockError::WouldBlock) => sleep(BETWEEN_ATTEMPTS),
                Err(TryLockError::Error(_)) => return None,
            }
        }
        None
    }
}
