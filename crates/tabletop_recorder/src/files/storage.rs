//! Every operation on files that the recorder does, so that tests can make each of them fail.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread::sleep,
    time::Duration,
};

use tabletop_core::{Symlinks, open_regular_file, require_regular_file};

/// Number of attempts to get a lock.
const LOCK_ATTEMPTS: u32 = 100;
const BETWEEN_LOCK_ATTEMPTS: Duration = Duration::from_millis(5);

/// The place of recordings: the file system.
///
/// Tests make one of its calls fail. The calls of a recording are counted from 0; the same commands make the same calls.
///
/// ```
/// use tabletop_recorder::{StorageFault, Storage};
///
/// let counted = Storage::default();
/// let failing = Storage::with_fault(StorageFault::Full, 12);
/// assert_eq!((counted.calls(), failing.calls()), (0, 0));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Storage {
    calls: Arc<AtomicU64>,
    failpoint: Option<(StorageFault, u64)>,
}

/// The failure of calls to a [`Storage`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StorageFault {
    /// One call finds the disk full. Of what it was to write, half is written.
    FullOnce,
    /// From one call on, the disk is full.
    Full,
    /// One call fails for a reason that has nothing to do with it, as a broken disk has.
    Broken,
    /// The program is killed before a call: nothing later reaches the disk.
    Killed,
    /// The program is killed in a call: of what it was to write, half is written.
    KilledWithin,
}

impl StorageFault {
    /// All faults.
    pub const ALL: [Self; 5] = [
        Self::FullOnce,
        Self::Full,
        Self::Broken,
        Self::Killed,
        Self::KilledWithin,
    ];

    fn is_at(self, call: u64, failing: u64) -> bool {
        match self {
            Self::FullOnce | Self::Broken => call == failing,
            Self::Full | Self::Killed | Self::KilledWithin => call >= failing,
        }
    }

    fn error(self) -> io::Error {
        match self {
            Self::FullOnce | Self::Full => ErrorKind::StorageFull.into(),
            Self::Broken => io::Error::other("input/output error"),
            Self::Killed | Self::KilledWithin => io::Error::other("the program was killed"),
        }
    }

    /// True if the call that fails writes half of what it was to write.
    fn tears(self, call: u64, failing: u64) -> bool {
        match self {
            Self::FullOnce | Self::Full | Self::KilledWithin => call == failing,
            Self::Broken | Self::Killed => false,
        }
    }
}

impl Storage {
    /// A storage of which this call fails.
    pub fn with_fault(fault: StorageFault, call: u64) -> Self {
        Self {
            failpoint: Some((fault, call)),
            ..Self::default()
        }
    }

    /// The number of calls.
    pub fn calls(&self) -> u64 {
        self.calls.load(Ordering::Relaxed)
    }

    /// Counts a call, and lets it fail if it is to. Half of what it was to write is then given to `tear`.
    fn call(&self, tear: impl FnOnce()) -> io::Result<()> {
        let call = self.calls.fetch_add(1, Ordering::Relaxed);
        let Some((fault, failing)) = self.failpoint else {
            return Ok(());
        };
        if !fault.is_at(call, failing) {
            return Ok(());
        }
        if fault.tears(call, failing) {
            tear();
        }
        Err(fault.error())
    }

    /// If a call is to fail, no power is lost.
    fn waits_for_disk(&self) -> bool {
        self.failpoint.is_none()
    }

    fn may(&self) -> io::Result<()> {
        self.call(|| {})
    }

    /// Makes a new file, to be read and written.
    pub(crate) fn create(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create_new(true)
            .open(path)?;
        Ok(self.stored(file))
    }

    /// Opens a file, to be read and written.
    pub(crate) fn open(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        require_regular_file(path, Symlinks::Refused)?;
        let file = OpenOptions::new().read(true).write(true).open(path)?;
        Ok(self.stored(file))
    }

    /// Opens a file, to be read.
    pub(crate) fn open_to_read(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        Ok(self.stored(open_regular_file(path, Symlinks::Refused)?))
    }

    fn stored(&self, file: File) -> StoredFile {
        StoredFile {
            file,
            storage: self.clone(),
        }
    }

    /// The content of a file, which is refused if it has more bytes than this.
    pub(crate) fn read(&self, path: &Path, most_bytes: u64) -> io::Result<Vec<u8>> {
        read_at_most(&self.open_to_read(path)?.file, most_bytes)
    }

    /// Writes a file that under its name is never incomplete.
    pub(crate) fn write_whole(&self, path: &Path, bytes: &[u8], sync: bool) -> io::Result<()> {
        let part = part_of(path);
        let written = self.write_and_rename(&part, path, bytes, sync);
        if written.is_err() {
            // An unwritten file need not exist.
            let _removed = self.remove_file(&part);
        }
        written
    }

    fn write_and_rename(
        &self,
        part: &Path,
        path: &Path,
        bytes: &[u8],
        sync: bool,
    ) -> io::Result<()> {
        self.may()?;
        let mut file = self.stored(File::create(part)?);
        file.append(bytes)?;
        if sync {
            file.sync()?;
        }
        self.rename(part, path)
    }

    pub(crate) fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.may()?;
        fs::rename(from, to)
    }

    /// Makes a folder that is not there yet.
    pub(crate) fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::create_dir(path)
    }

    /// Makes a folder and its missing parents.
    pub(crate) fn create_folders(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::create_dir_all(path)
    }

    pub(crate) fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::remove_file(path)
    }

    /// Removes a folder with all that is in it, one call each.
    pub(crate) fn remove_folder(&self, path: &Path) -> io::Result<()> {
        for entry in self.entries(path)? {
            match entry.symlink_metadata()?.is_dir() {
                true => self.remove_folder(&entry)?,
                false => self.remove_file(&entry)?,
            }
        }
        self.may()?;
        fs::remove_dir(path)
    }

    /// The entries of a folder, in the order of the names.
    pub(crate) fn entries(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        self.may()?;
        let entries = fs::read_dir(folder)?;
        let paths: Result<Vec<_>, _> = entries.map(|entry| Ok(entry?.path())).collect();
        paths.map(|mut paths| {
            paths.sort();
            paths
        })
    }

    /// Makes the content of a folder outlive a loss of power.
    pub(crate) fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        // Windows opens no folders.
        match cfg!(unix) && self.waits_for_disk() {
            true => File::open(path)?.sync_all(),
            false => Ok(()),
        }
    }

    /// Makes a folder with all its content outlive a loss of power.
    pub(crate) fn sync_tree(&self, folder: &Path) -> io::Result<()> {
        for entry in self.entries(folder)? {
            match entry.symlink_metadata()?.is_dir() {
                true => self.sync_tree(&entry)?,
                false => self.open(&entry)?.sync()?,
            }
        }
        self.sync_folder(folder)
    }
}

/// A file in a [`Storage`].
#[derive(Debug)]
pub(crate) struct StoredFile {
    file: File,
    storage: Storage,
}

impl StoredFile {
    /// Writes where the last writing ended.
    pub(crate) fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let (storage, file) = (&self.storage, &mut self.file);
        storage.call(|| {
            // A call that fails may have written something.
            let _half = bytes
                .get(..bytes.len() / 2)
                .map(|half| file.write_all(half));
        })?;
        self.file.write_all(bytes)
    }

    /// Keeps the first `len` bytes; appended bytes come after them.
    pub(crate) fn cut(&mut self, len: u64) -> io::Result<()> {
        self.storage.may()?;
        self.file.set_len(len)?;
        self.file.seek(SeekFrom::Start(len)).map(drop)
    }

    pub(crate) fn len(&self) -> io::Result<u64> {
        self.storage.may()?;
        Ok(self.file.metadata()?.len())
    }

    /// The bytes after the first `start`, which is refused if it has more bytes than this. The file is then at its end.
    pub(crate) fn read_from(&mut self, start: u64, most_bytes: u64) -> io::Result<Vec<u8>> {
        self.storage.may()?;
        self.file.seek(SeekFrom::Start(start))?;
        read_at_most(&self.file, most_bytes)
    }

    pub(crate) fn sync(&self) -> io::Result<()> {
        self.storage.may()?;
        match self.storage.waits_for_disk() {
            true => self.file.sync_all(),
            false => Ok(()),
        }
    }

    /// Waits, but not for long, until nobody else has it in use, or there is no need any more to have it. Says whether it is now in use
    /// by this program.
    pub(crate) fn lock_unless(&self, is_needless: impl Fn() -> bool) -> bool {
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
    pub(crate) fn try_lock(&self) -> bool {
        // A lock of Windows would keep everybody from reading; but there, no folder with an open file is moved. Where a file system
        // knows no locks, all goes on without.
        let locked = match cfg!(unix) {
            true => self.file.try_lock(),
            false => Ok(()),
        };
        !matches!(locked, Err(TryLockError::WouldBlock))
    }
}

/// True if there is something of this name, be it a link to nothing.
pub fn is_taken(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// The name of a file that is not complete.
fn part_of(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Makes sure that it is a folder, and no link to one.
pub(crate) fn require_folder(path: &Path) -> io::Result<()> {
    match path.symlink_metadata()?.is_dir() {
        true => Ok(()),
        false => Err(io::Error::new(
            ErrorKind::NotADirectory,
            "it is no folder, and a recording has one there",
        )),
    }
}

fn read_at_most(mut file: &File, most_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most_bytes).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == most_bytes && file.read(&mut [0])? > 0 {
        let reason = format!("it has more than {most_bytes} bytes, the most that are read");
        return Err(io::Error::new(ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}
