//! Files that under their names are never incomplete.

use std::{
    fs,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process,
};

use crate::{
    path::{hidden_prefix, is_taken, parent_of},
    storage::Storage,
    stored_file::StoredFile,
};

/// Number of hidden names that are tried.
const NAMES: u32 = 1000;

impl Storage {
    /// Replaces a file that the user has named, or makes it: whole and on the disk, or all is as before. The file behind a link is replaced,
    /// not the link. A pipe or a device is written to.
    ///
    /// # Errors
    /// It cannot be written, or is a folder.
    pub fn replace(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        match path.metadata() {
            Ok(there) if there.is_dir() => Err(ErrorKind::IsADirectory.into()),
            Ok(there) if !there.is_file() => self.open_to_write(path)?.append(bytes),
            Ok(there) => {
                let path = path.canonicalize()?;
                let keep_permissions = |part: &Path| fs::set_permissions(part, there.permissions());
                self.write_beside(&path, bytes, keep_permissions)
            }
            Err(error) if error.kind() == ErrorKind::NotFound && !is_taken(path) => {
                self.write_beside(path, bytes, |_| Ok(()))
            }
            Err(error) => Err(error),
        }
    }

    /// Gives its name to a new file, whole and on the disk, or all is as before. A link of this name, which a stranger may have made, is
    /// replaced itself.
    ///
    /// # Errors
    /// It cannot be written, or is a folder.
    pub fn replace_name(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.write_beside(path, bytes, |_| Ok(()))
    }

    /// Writes a file that is not there yet, whole and on the disk, or not at all.
    ///
    /// # Errors
    /// Something is there, or it cannot be written.
    pub fn write_new(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if is_taken(path) {
            return Err(ErrorKind::AlreadyExists.into());
        }
        let (part, file) = self.create_beside(path)?;
        self.fill_and_name(Ok(file), &part, bytes, true, || self.name_new(&part, path))
    }

    /// Checks that a file can be replaced or made, without leaving a trace.
    ///
    /// # Errors
    /// As [`replace`](Self::replace).
    pub fn check_replaceable(&self, path: &Path) -> io::Result<()> {
        match path.metadata() {
            Ok(there) if there.is_dir() => Err(ErrorKind::IsADirectory.into()),
            // Opening and closing a pipe would signal its end to the reader.
            Ok(there) if !there.is_file() => Ok(()),
            Ok(_) => self.check_beside(&path.canonicalize()?),
            Err(error) if error.kind() == ErrorKind::NotFound && !is_taken(path) => {
                self.check_beside(path)
            }
            Err(error) => Err(error),
        }
    }

    /// Writes a file of a folder that is the program's own, which under its name is never incomplete.
    ///
    /// # Errors
    /// It cannot be written; then the old one is there.
    pub fn write_whole(&self, path: &Path, bytes: &[u8], sync: bool) -> io::Result<()> {
        let mut part = path.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let file = self.create_or_empty(&part);
        self.fill_and_name(file, &part, bytes, sync, || self.rename(&part, path))
    }

    fn write_beside(
        &self,
        path: &Path,
        bytes: &[u8],
        prepare: impl FnOnce(&Path) -> io::Result<()>,
    ) -> io::Result<()> {
        let (part, file) = self.create_beside(path)?;
        let file = prepare(&part).map(|()| file);
        self.fill_and_name(file, &part, bytes, true, || self.rename(&part, path))
    }

    fn check_beside(&self, path: &Path) -> io::Result<()> {
        let (part, file) = self.create_beside(path)?;
        drop(file);
        self.remove_file(&part)
    }

    /// Makes a new file under a hidden name beside another.
    fn create_beside(&self, path: &Path) -> io::Result<(PathBuf, StoredFile)> {
        let prefix = hidden_prefix(path);
        for number in 0..NAMES {
            let name = format!("{prefix}{}-{number}", process::id());
            let part = parent_of(path).join(name);
            match self.create(&part) {
                Ok(file) => return Ok((part, file)),
                // Left by a killed program of the same number.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    fn fill_and_name(
        &self,
        part: io::Result<StoredFile>,
        at: &Path,
        bytes: &[u8],
        sync: bool,
        name: impl FnOnce() -> io::Result<()>,
    ) -> io::Result<()> {
        let written = part
            .and_then(|mut part| {
                part.append(bytes)?;
                match sync {
                    true => part.sync(),
                    false => Ok(()),
                }
            })
            .and_then(|()| name());
        if written.is_err() {
            // An unwritten file need not exist.
            let _removed = self.remove_file(at);
        }
        written
    }
}
