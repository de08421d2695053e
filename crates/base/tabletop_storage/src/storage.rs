//! Every call that changes the file system, so that tests can make each of them fail.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, ErrorKind, Read as _},
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use crate::{
    calls::Calls,
    fault::{Fate, FaultAt, StorageFault},
    path::first_free_name,
    patience::Patience,
    regular_file::{Symlinks, open_regular_file, require_regular_file},
    stored_file::{StoredFile, read_at_most},
};

/// Number of bytes of a file that are copied at a time.
const COPIED_AT_ONCE: usize = 1 << 20;

/// The file system.
///
/// Tests make one of its calls fail. Its calls are counted from 0; the same work makes the same calls.
///
/// ```
/// use tabletop_storage::{StorageFault, Storage};
///
/// let counted = Storage::default();
/// let failing = Storage::with_fault(StorageFault::Full, 12);
/// assert_eq!((counted.calls(), failing.calls()), (0, 0));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Storage {
    calls: Calls,
    patience: Patience,
}

impl Storage {
    /// A storage of which this call fails.
    pub fn with_fault(fault: StorageFault, call: u64) -> Self {
        Self::with_fate(Arc::new(FaultAt::new(fault, call)))
    }

    /// A storage whose calls have this fate.
    pub fn with_fate(fate: Arc<dyn Fate>) -> Self {
        Self {
            calls: Calls::with_fate(fate),
            patience: Patience::default(),
        }
    }

    /// The same, which does this where another program writes.
    #[must_use]
    pub fn with_patience(self, patience: Patience) -> Self {
        Self { patience, ..self }
    }

    pub(crate) const fn patience(&self) -> Patience {
        self.patience
    }

    /// The number of calls.
    pub fn calls(&self) -> u64 {
        self.calls.count()
    }

    /// The number of bytes that were written to files.
    pub fn bytes_written(&self) -> u64 {
        self.calls.bytes()
    }

    /// The number of times that something was made to outlive a loss of power, for which the disk is waited for.
    pub fn syncs(&self) -> u64 {
        self.calls.syncs()
    }

    fn may(&self) -> io::Result<()> {
        self.calls.may()
    }

    /// Makes a new file, to be read and written.
    ///
    /// # Errors
    /// Something is there, or it cannot be made.
    pub fn create(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create_new(true)
            .open(path)?;
        Ok(self.stored(file))
    }

    /// Makes a file, or empties the one that is there.
    pub(crate) fn create_or_empty(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        Ok(self.stored(File::create(path)?))
    }

    /// Opens a file, to be read and written.
    ///
    /// # Errors
    /// It is no regular file, or cannot be opened.
    pub fn open(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        require_regular_file(path, Symlinks::Refused)?;
        let file = OpenOptions::new().read(true).write(true).open(path)?;
        Ok(self.stored(file))
    }

    /// Opens a path for writing, be it a pipe.
    pub(crate) fn open_to_write(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        Ok(self.stored(OpenOptions::new().append(true).open(path)?))
    }

    /// Opens a file, to be read.
    ///
    /// # Errors
    /// It is no regular file, or cannot be opened.
    pub fn open_to_read(&self, path: &Path) -> io::Result<StoredFile> {
        self.may()?;
        Ok(self.stored(open_regular_file(path, Symlinks::Refused)?))
    }

    /// Lets others go on for a while.
    pub(crate) fn pause(&self, time: Duration) {
        self.calls.pause(time);
    }

    fn stored(&self, file: File) -> StoredFile {
        StoredFile::new(file, self.calls.clone())
    }

    /// The content of a file, which is refused if it has more bytes than this.
    ///
    /// # Errors
    /// It is no regular file, or cannot be read.
    pub fn read(&self, path: &Path, most_bytes: u64) -> io::Result<Vec<u8>> {
        read_at_most(self.open_to_read(path)?.file(), most_bytes)
    }

    /// Copies a folder with all that is in it to where nothing is; what has a hidden name, which is for the program alone, stays behind.
    ///
    /// # Errors
    /// It holds anything else than files and folders, or something cannot be read or written.
    pub fn copy_folder(&self, from: &Path, to: &Path) -> io::Result<()> {
        let mut folders = vec![(from.to_owned(), to.to_owned())];
        while let Some((from, to)) = folders.pop() {
            self.create_folder(&to)?;
            for entry in self.entries(&from)? {
                let name = entry.file_name().unwrap_or_default();
                if name.to_string_lossy().starts_with('.') {
                    continue;
                }
                let copy = to.join(name);
                match entry.symlink_metadata()?.is_dir() {
                    true => folders.push((entry, copy)),
                    false => self.copy_file(&entry, &copy)?,
                }
            }
        }
        Ok(())
    }

    fn copy_file(&self, from: &Path, to: &Path) -> io::Result<()> {
        let named =
            |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", from.display()));
        let mut file = open_regular_file(from, Symlinks::Refused).map_err(named)?;
        let mut copy = self.create(to)?;
        let mut bytes = vec![0; COPIED_AT_ONCE];
        loop {
            match file.read(&mut bytes).map_err(named)? {
                0 => return Ok(()),
                read => copy.append(&bytes[..read])?,
            }
        }
    }

    /// Gives another name to a file or folder.
    ///
    /// # Errors
    /// It has not the name, or cannot get the other one.
    pub fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.may()?;
        fs::rename(from, to)
    }

    /// Gives a file a name that nothing has yet.
    ///
    /// # Errors
    /// Something has the name, or it cannot get it.
    pub(crate) fn name_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.may()?;
        match fs::hard_link(from, to) {
            Ok(()) => {
                // It has two names, of which the hidden one is no matter.
                let _stays = self.remove_file(from);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
            // The file system has no links: the name is taken by an empty file first.
            Err(_) => {
                drop(self.create(to)?);
                let named = self.rename(from, to);
                if named.is_err() {
                    // The failure is reported; more cannot be done.
                    let _stays = self.remove_file(to);
                }
                named
            }
        }
    }

    /// Gives a folder the name of an empty one, in its place.
    ///
    /// # Errors
    /// The other one is not empty, or it cannot be named so.
    pub fn rename_onto_empty(&self, from: &Path, to: &Path) -> io::Result<()> {
        if cfg!(not(unix)) {
            // Windows renames onto nothing.
            self.remove_empty(to)?;
        }
        self.rename(from, to)
    }

    /// Moves a folder to a free name, which is returned: its own with a number appended.
    ///
    /// # Errors
    /// It cannot be renamed. The name that it should have got comes with the reason.
    pub fn move_aside(&self, path: &Path) -> Result<PathBuf, (PathBuf, io::Error)> {
        let aside = first_free_name(path);
        match self.rename(path, &aside) {
            Ok(()) => Ok(aside),
            Err(source) => Err((aside, source)),
        }
    }

    /// Makes a folder that is not there yet.
    ///
    /// # Errors
    /// Something is there, or it cannot be made.
    pub fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::create_dir(path)
    }

    /// Makes a folder and its missing parents.
    ///
    /// # Errors
    /// One of them cannot be made.
    pub fn create_folders(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::create_dir_all(path)
    }

    /// Removes a file.
    ///
    /// # Errors
    /// It is not there, or cannot be removed.
    pub fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::remove_file(path)
    }

    /// Removes a folder in which nothing is.
    ///
    /// # Errors
    /// Something is in it, or it cannot be removed.
    pub fn remove_empty(&self, path: &Path) -> io::Result<()> {
        self.may()?;
        fs::remove_dir(path)
    }

    /// Removes a folder with all that is in it, one call each.
    ///
    /// # Errors
    /// A part of it cannot be removed.
    pub fn remove_folder(&self, path: &Path) -> io::Result<()> {
        for entry in self.entries(path)? {
            match entry.symlink_metadata()?.is_dir() {
                true => self.remove_folder(&entry)?,
                false => self.remove_file(&entry)?,
            }
        }
        self.remove_empty(path)
    }

    /// The entries of a folder, in the order of the names.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn entries(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        self.may()?;
        let entries = fs::read_dir(folder)?;
        let paths: Result<Vec<_>, _> = entries.map(|entry| Ok(entry?.path())).collect();
        paths.map(|mut paths| {
            paths.sort();
            paths
        })
    }

    /// Makes the names in a folder outlive a loss of power.
    ///
    /// # Errors
    /// The disk does not take them.
    pub fn sync_folder(&self, path: &Path) -> io::Result<()> {
        // Windows opens no folders.
        self.calls.sync(|| match cfg!(unix) {
            true => File::open(path)?.sync_all(),
            false => Ok(()),
        })
    }

    /// Makes a folder with all its content outlive a loss of power.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn sync_tree(&self, folder: &Path) -> io::Result<()> {
        for entry in self.entries(folder)? {
            match entry.symlink_metadata()?.is_dir() {
                true => self.sync_tree(&entry)?,
                false => self.open(&entry)?.sync()?,
            }
        }
        self.sync_folder(folder)
    }
}
