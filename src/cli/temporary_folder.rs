//! Temporary folders: they are removed with the program that made them, or by the next one if it was killed.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
    process,
};

use tabletop::core::{Symlinks, open_regular_file};

/// The file in a temporary folder that is locked as long as its program runs.
const LOCK: &str = "lock";

/// A folder that is removed when it is dropped. Making one also removes the folders of the same kind that killed programs left.
pub(super) struct TemporaryFolder {
    path: PathBuf,
    _lock: File,
}

impl TemporaryFolder {
    /// Makes a new folder of this kind.
    pub(super) fn new(kind: &str) -> io::Result<Self> {
        Self::new_in(&std::env::temp_dir(), kind)
    }

    fn new_in(parent: &Path, kind: &str) -> io::Result<Self> {
        remove_what_killed_programs_left(parent, kind);
        let path = parent.join(format!("{kind}-{}", process::id()));
        let in_its_place = |source: io::Error| {
            let reason = format!("{}: {source}", path.display());
            io::Error::new(source.kind(), reason)
        };
        let made = fs::create_dir(&path).or_else(|error| {
            // Left by an earlier program with this process id.
            if error.kind() == io::ErrorKind::AlreadyExists {
                fs::remove_dir_all(&path).and_then(|()| fs::create_dir(&path))
            } else {
                Err(error)
            }
        });
        made.map_err(in_its_place)?;
        let lock = File::create(path.join(LOCK)).map_err(in_its_place)?;
        // A file system without locks is no obstacle.
        let _ = lock.try_lock();
        Ok(Self { path, _lock: lock })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // Then the next one removes it.
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// Removes the folders of this kind whose programs do not run any more.
fn remove_what_killed_programs_left(parent: &Path, kind: &str) {
    let Ok(entries) = fs::read_dir(parent) else {
        return;
    };
    let prefix = format!("{kind}-");
    for entry in entries.flatten() {
        let is_of_this_kind = entry
            .file_name()
            .to_string_lossy()
            .strip_prefix(&prefix)
            .is_some_and(|id| id.parse::<u32>().is_ok());
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_of_this_kind && is_folder && is_abandoned(&entry.path()) {
            // Another user's, or a disk that fails: it stays.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// True if a folder's lock exists and nobody holds it.
fn is_abandoned(folder: &Path) -> bool {
    let lock = open_regular_file(&folder.join(LOCK), Symlinks::Refused);
    let lock = lock.map(|lock| lock.try_lock());
    matches!(lock, Ok(Ok(())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_with_its_program_or_with_the_next_one() {
        let parent = TemporaryFolder::new("tabletop-test-temporary").unwrap();
        let place = parent.path();
        let first = TemporaryFolder::new_in(place, "kind").unwrap();
        fs::write(first.path().join("file"), "content").unwrap();
        let left = [
            place.join("kind-1"),
            place.join("kind-2"),
            place.join("kind-x"),
        ];
        for folder in &left {
            fs::create_dir(folder).unwrap();
            File::create(folder.join(LOCK)).unwrap();
        }
        let running = File::open(left[1].join(LOCK)).unwrap();
        running.lock().unwrap();
        remove_what_killed_programs_left(place, "kind");
        assert!(first.path().exists(), "its program runs");
        let stays: Vec<_> = left.iter().map(|folder| folder.exists()).collect();
        assert_eq!(stays, [false, true, true]);
        let path = first.path().to_owned();
        drop(first);
        assert!(!path.exists());
    }
}
