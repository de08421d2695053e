//! Files in the folders of strangers.

use std::{
    fs::File,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use crate::{
    inner_path::InnerPath,
    path::{is_taken, parent_of},
    regular_file::{NO_FILE, read_bounded},
};

/// A file in a folder that a stranger may have made. It is reached without a link: neither it nor a folder on the way to it is one. The
/// folder itself may be, since the user has named it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InnerFile {
    folder: PathBuf,
    inner: InnerPath,
}

impl InnerFile {
    /// The file of this path in a folder.
    pub fn new(folder: &Path, inner: InnerPath) -> Self {
        Self {
            folder: folder.to_owned(),
            inner,
        }
    }

    /// The file that the user names, behind the links that he names.
    ///
    /// # Errors
    /// It is not there, or is the root of all folders.
    pub fn at(path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        let name = InnerPath::name(path.file_name().unwrap_or_default());
        let inner = name.map_err(|_| io::Error::from(ErrorKind::IsADirectory))?;
        Ok(Self::new(parent_of(&path), inner))
    }

    /// Its path, to be shown.
    pub fn path(&self) -> PathBuf {
        self.inner.below(&self.folder)
    }

    /// True if there is something of its name, be it a link.
    pub fn is_taken(&self) -> bool {
        is_taken(&self.path())
    }

    /// Opens it to read it.
    ///
    /// # Errors
    /// It is no regular file, a link is on the way, or it cannot be opened.
    pub fn open(&self) -> io::Result<File> {
        let file = open_without_links(&self.folder, &self.inner)?;
        match file.metadata()?.is_file() {
            true => Ok(file),
            false => Err(io::Error::other(NO_FILE)),
        }
    }

    /// Its bytes.
    ///
    /// # Errors
    /// As [`open`](Self::open), and if it has more than `most` bytes or cannot be read.
    pub fn read(&self, most: u64) -> io::Result<Vec<u8>> {
        read_bounded(self.open()?, most)
    }
}

/// Makes sure that no link is followed to a path in a folder that a stranger may have made: no name of it, as far as it is there, is one.
///
/// # Errors
/// One is, or cannot be looked at.
pub fn require_no_links(folder: &Path, inner: &InnerPath) -> io::Result<()> {
    let mut path = folder.to_owned();
    for name in inner.names() {
        path.push(name);
        match path.symlink_metadata() {
            Ok(found) if found.is_symlink() => return Err(linked(&path)),
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// The fault that a folder on the way to a file is a link.
fn linked(folder: &Path) -> io::Error {
    let problem = format!(
        "its folder {} is a link, which could lead anywhere; put what it leads to in its place",
        folder.display()
    );
    io::Error::new(ErrorKind::InvalidInput, problem)
}

/// The fault of what is in the place of a file, or of a folder before it.
#[cfg(unix)]
fn fault_at(path: &Path, is_last: bool, error: io::Error) -> io::Error {
    match path.is_symlink() {
        true if is_last => io::Error::other(NO_FILE),
        true => linked(path),
        false => error,
    }
}

/// Opens name after name, each in the folder that was opened before, so that no link is followed even if one is made meanwhile.
#[cfg(unix)]
fn open_without_links(folder: &Path, inner: &InnerPath) -> io::Result<File> {
    use rustix::fs::{Mode, OFlags, openat};

    let mut path = folder.to_owned();
    let mut open = File::open(folder)?;
    let mut names = inner.names().peekable();
    while let Some(name) = names.next() {
        path.push(name);
        // Nobody waits for the other end of a pipe.
        let flags = OFlags::RDONLY | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let opened = openat(&open, name, flags, Mode::empty());
        let is_last = names.peek().is_none();
        open = opened
            .map_err(|error| fault_at(&path, is_last, error.into()))?
            .into();
    }
    Ok(open)
}

#[cfg(not(unix))]
fn open_without_links(folder: &Path, inner: &InnerPath) -> io::Result<File> {
    let mut path = folder.to_owned();
    for name in inner.names() {
        path.push(name);
        if path.symlink_metadata()?.is_symlink() {
            return Err(linked(&path));
        }
    }
    File::open(path)
}

#[cfg(test)]
mod tests {
    use std::{env::temp_dir, fs, process};

    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = temp_dir().join(format!("tabletop_inner_{name}_{}", process::id()));
        fs::create_dir_all(folder.join("set/inside")).unwrap();
        fs::write(folder.join("set/inside/file"), "inside").unwrap();
        fs::write(folder.join("outside"), "outside").unwrap();
        folder
    }

    fn file(folder: &Path, path: &str) -> InnerFile {
        InnerFile::new(&folder.join("set"), InnerPath::new(path).unwrap())
    }

    #[test]
    fn files_below_are_read_up_to_a_size() {
        let folder = folder("read");
        let inside = file(&folder, "inside/file");
        assert_eq!(inside.read(6).unwrap(), b"inside");
        assert!(inside.read(5).is_err());
        assert!(file(&folder, "inside").open().is_err());
        let missing = file(&folder, "inside/none").open().unwrap_err();
        assert_eq!(missing.kind(), ErrorKind::NotFound);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn no_link_below_the_folder_is_followed() {
        use std::os::unix::fs::symlink;

        let folder = folder("links");
        let set = folder.join("set");
        symlink("../outside", set.join("link")).unwrap();
        symlink("inside", set.join("folder")).unwrap();
        symlink(&set, folder.join("named")).unwrap();
        for path in ["link", "folder/file"] {
            let error = file(&folder, path).open().unwrap_err().to_string();
            assert!(error.contains("a link"), "{path}: {error}");
        }
        for (path, is_free) in [
            ("link", false),
            ("folder", false),
            ("folder/new", false),
            ("inside/file", true),
            ("none/new", true),
        ] {
            let checked = require_no_links(&set, &InnerPath::new(path).unwrap());
            assert_eq!(checked.is_ok(), is_free, "{path}");
        }
        // The user has named this one.
        let named = InnerFile::new(
            &folder.join("named"),
            InnerPath::new("inside/file").unwrap(),
        );
        assert_eq!(named.read(6).unwrap(), b"inside");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn nobody_waits_for_a_pipe() {
        let folder = folder("pipe");
        let pipe = folder.join("set/pipe");
        rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RUSR).unwrap();
        let error = file(&folder, "pipe").open().unwrap_err().to_string();
        assert!(error.contains("a device"), "{error}");
        fs::remove_dir_all(folder).unwrap();
    }
}
