//! A file in a storage.

use std::{
    fs::{File, TryLockError},
    io::{self, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _},
    path::Path,
    thread::sleep,
    time::Duration,
};

use crate::calls::Calls;

/// Number of attempts to get a lock.
const LOCK_ATTEMPTS: u32 = 100;
const BETWEEN_LOCK_ATTEMPTS: Duration = Duration::from_millis(5);

/// A file in a [`Storage`](crate::Storage).
#[derive(Debug)]
pub struct StoredFile {
    file: File,
    calls: Calls,
}

impl StoredFile {
    pub(crate) const fn new(file: File, calls: Calls) -> Self {
        Self { file, calls }
    }

    /// Writes where the last writing ended.
    ///
    /// # Errors
    /// It cannot be written; a part may be.
    pub fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let (calls, file) = (&self.calls, &mut self.file);
        calls.call(|| {
            // A call that fails may have written something.
            let _half = bytes
                .get(..bytes.len() / 2)
                .map(|half| file.write_all(half));
        })?;
        self.calls.count_bytes(bytes.len());
        self.file.write_all(bytes)
    }

    /// Keeps the first `len` bytes; appended bytes come after them.
    ///
    /// # Errors
    /// It cannot be changed.
    pub fn cut(&mut self, len: u64) -> io::Result<()> {
        self.calls.may()?;
        self.file.set_len(len)?;
        self.file.seek(SeekFrom::Start(len)).map(drop)
    }

    /// Number of its bytes.
    ///
    /// # Errors
    /// It cannot be asked.
    pub fn byte_count(&self) -> io::Result<u64> {
        self.calls.may()?;
        Ok(self.file.metadata()?.len())
    }

    /// The bytes after the first `start`, which is refused if it has more bytes than this. The file is then at its end.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read_from(&mut self, start: u64, most_bytes: u64) -> io::Result<Vec<u8>> {
        self.calls.may()?;
        self.file.seek(SeekFrom::Start(start))?;
        read_at_most(&self.file, most_bytes)
    }

    /// Makes its content outlive a loss of power.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn sync(&self) -> io::Result<()> {
        self.calls.sync(|| self.file.sync_all())
    }

    /// True if it is the file at this path: neither it nor a folder around it was renamed, replaced or removed since.
    ///
    /// # Errors
    /// The path cannot be looked at.
    pub fn is_at(&self, path: &Path) -> io::Result<bool> {
        self.calls.may()?;
        match path.symlink_metadata() {
            Ok(there) => Ok(is_same(&self.file.metadata()?, &there)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Waits, but not for long, until nobody else has it in use, or there is no need any more to have it. Says whether it is now in use
    /// by this program.
    pub fn lock_unless(&self, is_needless: impl Fn() -> bool) -> bool {
        for _ in 0..LOCK_ATTEMPTS {
            if self.try_lock() {
                return true;
            }
            if is_needless() {
                return false;
            }
            sleep(BETWEEN_LOCK_ATTEMPTS);
        }
        false
    }

    /// Lets others know that it is in use, as long as this is there. Says whether nobody else does so.
    pub fn try_lock(&self) -> bool {
        // A lock of Windows would keep everybody from reading; but there, no folder with an open file is moved. Where a file system
        // knows no locks, all goes on without.
        let locked = match cfg!(unix) {
            true => self.file.try_lock(),
            false => Ok(()),
        };
        !matches!(locked, Err(TryLockError::WouldBlock))
    }

    /// True if somebody else has it [locked](Self::try_lock).
    pub fn is_locked_by_other(&self) -> bool {
        let locked = match cfg!(unix) {
            true => self.file.try_lock_shared(),
            false => Ok(()),
        };
        matches!(locked, Err(TryLockError::WouldBlock))
    }

    /// Locks it against all who try the same. Says whether that has succeeded: nobody has the lock, and the file system knows locks.
    pub(crate) fn is_locked_now(&self) -> bool {
        self.file.try_lock().is_ok()
    }

    /// Locks it against all others.
    pub(crate) fn try_lock_alone(&self) -> Result<(), TryLockError> {
        self.file.try_lock()
    }

    /// Locks it against all who want it alone.
    pub(crate) fn try_lock_shared(&self) -> Result<(), TryLockError> {
        self.file.try_lock_shared()
    }

    pub(crate) const fn file(&self) -> &File {
        &self.file
    }
}

#[cfg(unix)]
fn is_same(one: &std::fs::Metadata, other: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

/// Windows neither renames nor removes a folder with an open file.
#[cfg(not(unix))]
fn is_same(_one: &std::fs::Metadata, _other: &std::fs::Metadata) -> bool {
    true
}

pub(crate) fn read_at_most(mut file: &File, most_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most_bytes).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == most_bytes && file.read(&mut [0])? > 0 {
        let reason = format!("it has more than {most_bytes} bytes, the most that are read");
        return Err(io::Error::new(ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}
