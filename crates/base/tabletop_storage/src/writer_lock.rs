//! Locks of those who write: one at a time has a place, for as long as it writes there.

use std::{
    ffi::OsString,
    fmt,
    fs::TryLockError,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process, str,
    time::Duration,
};

use jiff::Timestamp;

use crate::{
    path::{canonical, parent_of},
    patience::{GLANCE, Patience},
    storage::Storage,
    stored_file::StoredFile,
};

/// The file in a folder, or the end of the name of the file beside a place, that is locked while somebody writes there.
const LOCK: &str = ".tabletop-writer";

/// Largest size of such a file, in bytes.
const MOST_BYTES: u64 = 64;

const BETWEEN_ATTEMPTS: Duration = Duration::from_millis(10);

/// Keeps all others who ask for it from writing to a place. The operating system holds it for the program's life, so a killed program
/// leaves none.
#[derive(Debug)]
pub struct WriterLock {
    path: PathBuf,
    storage: Storage,
    file: StoredFile,
}

/// The program that writes to a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WritingProgram {
    place: PathBuf,
    /// Its number, and the time since which it writes, if it has written them down.
    known: Option<(u32, Timestamp)>,
}

impl fmt::Display for WritingProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.place.display();
        match self.known {
            Some((process, since)) => {
                let since = since.strftime("%Y-%m-%d %H:%M:%S UTC");
                write!(f, "{place}: process {process} writes there since {since}")
            }
            None => write!(f, "{place}: another program writes there"),
        }
    }
}

impl WriterLock {
    /// That of a folder that exists, for all in it.
    ///
    /// # Errors
    /// Somebody else has it and the storage is not to wait, or nothing can be written there.
    pub fn of_folder(folder: &Path, storage: &Storage) -> io::Result<Self> {
        Self::acquire(folder, folder.join(LOCK), storage)
    }

    /// That of a file or folder that may come to be, in a folder that exists.
    ///
    /// # Errors
    /// As [`of_folder`](Self::of_folder).
    pub fn of_place(place: &Path, storage: &Storage) -> io::Result<Self> {
        Self::acquire(place, beside(place), storage)
    }

    /// Whoever has the lock of a folder.
    pub fn writer_in(folder: &Path, storage: &Storage) -> Option<WritingProgram> {
        let path = folder.join(LOCK);
        let file = storage.open_to_read(&path).ok()?;
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => Some(writer_of(folder, &path, storage)),
            Ok(()) | Err(TryLockError::Error(_)) => None,
        }
    }

    fn acquire(place: &Path, path: PathBuf, storage: &Storage) -> io::Result<Self> {
        let patience = storage.patience();
        let mut waited = Duration::ZERO;
        loop {
            let Some(file) = open(&path, storage)? else {
                continue;
            };
            match file.try_lock_alone() {
                // Its last owner may have removed it before.
                Ok(()) if !file.is_at(&path)? => continue,
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let writer = || writer_of(place, &path, storage);
                    if waited >= patience.limit() {
                        return Err(busy(&writer()));
                    }
                    if waited == GLANCE {
                        let writer = writer();
                        patience.tell(&format_args!("{writer}; waiting for its end"));
                    }
                    storage.pause(BETWEEN_ATTEMPTS);
                    waited = waited.saturating_add(BETWEEN_ATTEMPTS);
                    continue;
                }
                Err(TryLockError::Error(error)) => {
                    without_locks(place, patience, &error)?;
                }
            }
            let lock = Self {
                path,
                storage: storage.clone(),
                file,
            };
            return lock.signed();
        }
    }

    /// Writes down who has it, and since when.
    fn signed(mut self) -> io::Result<Self> {
        let signature = format!("{} {}\n", process::id(), Timestamp::now().as_second());
        self.file.cut(0)?;
        self.file.append(signature.as_bytes())?;
        Ok(self)
    }
}

impl Drop for WriterLock {
    fn drop(&mut self) {
        // While it is held: whoever opened the file before finds that it is gone. One that stays is free.
        if self.file.is_at(&self.path).unwrap_or(false) {
            let _stays = self.storage.remove_file(&self.path);
        }
    }
}

/// Opens a lock's file, or makes it; `None` if its owner removed it meanwhile.
fn open(path: &Path, storage: &Storage) -> io::Result<Option<StoredFile>> {
    match storage.create(path) {
        Ok(file) => Ok(Some(file)),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => match storage.open(path) {
            Ok(file) => Ok(Some(file)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        },
        Err(error) => Err(error),
    }
}

/// The lock's file beside a place, whatever links lead there.
fn beside(place: &Path) -> PathBuf {
    let place = canonical(place);
    let mut name = OsString::from(".");
    name.push(place.file_name().unwrap_or_default());
    name.push(LOCK);
    parent_of(&place).join(name)
}

/// Whoever has signed a lock, which may be nobody yet.
fn writer_of(place: &Path, lock: &Path, storage: &Storage) -> WritingProgram {
    let bytes = storage.read(lock, MOST_BYTES).unwrap_or_default();
    let known = || {
        let mut words = str::from_utf8(&bytes).ok()?.split_whitespace();
        let process = words.next()?.parse().ok()?;
        let since = words.next()?.parse().ok()?;
        Some((process, Timestamp::from_second(since).ok()?))
    };
    WritingProgram {
        place: place.to_owned(),
        known: known(),
    }
}

fn busy(writer: &WritingProgram) -> io::Error {
    let reason = format!("{writer}; try again when it has ended");
    io::Error::new(ErrorKind::ResourceBusy, reason)
}

/// Goes on where the file system knows no locks, unless that is not to be.
fn without_locks(place: &Path, patience: Patience, error: &io::Error) -> io::Result<()> {
    let reason = format!(
        "{}: this file system has no locks ({error}); let no other program write there meanwhile",
        place.display()
    );
    match patience {
        Patience::None => Err(io::Error::new(ErrorKind::Unsupported, reason)),
        Patience::Wait(_) | Patience::Briefly => {
            patience.tell(&reason);
            Ok(())
        }
    }
}
