//! The files of a recording.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
    process,
    thread::sleep,
    time::Duration,
};

use crate::{
    error::RecorderError,
    files::storage::{Storage, is_taken, require_folder},
};

/// The folder of a recording.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    storage: Storage,
}

impl Folder {
    /// Fills a folder under a hidden name, gives it its own name, and opens it. An existing folder is moved aside to the same
    /// name with the first free number appended, unless a program is recording into it. If anything fails, nothing has changed.
    pub(crate) fn create<F, T>(
        path: &Path,
        storage: &Storage,
        fill: impl FnOnce(&Self) -> Result<F, RecorderError>,
        open: impl FnOnce(Self, F) -> Result<T, RecorderError>,
    ) -> Result<T, RecorderError> {
        let folder = Self::at(path, storage);
        let parent = parent_of(path);
        storage
            .create_folders(parent)
            .map_err(RecorderError::create(path))?;
        let is_alone = Starters::wait_for(parent);
        if is_alone.is_some() {
            folder.remove_what_killed_starters_left(parent);
        }
        folder.require_idle()?;

        let hidden = Self::at(&parent.join(folder.hidden_name(process::id())), storage);
        let filled = storage
            .create_folder(&hidden.path)
            .map_err(RecorderError::create(path))
            .and_then(|()| fill(&hidden));
        let opened =
            filled.and_then(|filled| folder.take_the_place(&hidden, |folder| open(folder, filled)));
        if opened.is_err() {
            // The failure is reported; more cannot be done.
            let _ = hidden.remove();
        }
        opened
    }

    /// Gives a hidden folder this one's name, and opens it there. If anything fails, all is as before.
    fn take_the_place<T>(
        &self,
        hidden: &Self,
        open: impl FnOnce(Self) -> Result<T, RecorderError>,
    ) -> Result<T, RecorderError> {
        let aside = match is_taken(&self.path) {
            true => Some(self.move_aside()?),
            false => None,
        };
        let placed = self.storage.rename(&hidden.path, &self.path);
        let is_placed = placed.is_ok();
        let opened = placed
            .map_err(RecorderError::create(&self.path))
            .and_then(|()| open(self.clone()));
        if opened.is_err() {
            // The failure is reported; more cannot be done.
            if is_placed {
                let _ = self.storage.rename(&self.path, &hidden.path);
            }
            if let Some(aside) = aside {
                let _ = self.storage.rename(&aside, &self.path);
            }
        }
        opened
    }

    /// Makes sure that what has this name is a folder into which nobody records.
    fn require_idle(&self) -> Result<(), RecorderError> {
        let folder = self.path.clone();
        if is_taken(&self.path) && !self.path.is_dir() {
            return Err(RecorderError::NoFolder { path: folder });
        }
        match self.is_in_use() {
            true => Err(RecorderError::InUse { folder }),
            false => Ok(()),
        }
    }

    fn is_in_use(&self) -> bool {
        let session = self.storage.open_to_read(&self.session());
        session.is_ok_and(|session| !session.lock_unless(|| false))
    }

    /// The name of this folder while it is being filled.
    fn hidden_name(&self, of: impl ToString) -> String {
        let name = self.path.components().next_back();
        let name = name.map(|name| name.as_os_str().to_string_lossy().into_owned());
        format!(".{}.new-{}", name.unwrap_or_default(), of.to_string())
    }

    /// Removes folders that programs were filling when they were killed.
    fn remove_what_killed_starters_left(&self, parent: &Path) {
        let prefix = self.hidden_name("");
        for entry in self.storage.entries(parent).unwrap_or_default() {
            let name = entry.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with(&prefix) && !entry.is_symlink() && entry.is_dir() {
                // Next time, then.
                let _stays = self.storage.remove_folder(&entry);
            }
        }
    }

    /// Moves the existing folder to a free name, which is returned.
    fn move_aside(&self) -> Result<PathBuf, RecorderError> {
        let aside = first_free_name(&self.path);
        match self.storage.rename(&self.path, &aside) {
            Ok(()) => Ok(aside),
            Err(source) => Err(RecorderError::MoveAside {
                folder: self.path.clone(),
                aside,
                source,
            }),
        }
    }

    pub(crate) fn existing(path: &Path) -> Self {
        Self::at(path, &Storage::default())
    }

    fn at(path: &Path, storage: &Storage) -> Self {
        Self {
            path: path.to_owned(),
            storage: storage.clone(),
        }
    }

    pub(crate) fn storage(&self) -> &Storage {
        &self.storage
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    pub(crate) fn session(&self) -> PathBuf {
        self.path.join("session.jsonl")
    }

    pub(crate) fn states(&self) -> PathBuf {
        self.path.join("states.csv")
    }

    pub(crate) fn joints(&self) -> PathBuf {
        self.path.join("joints.csv")
    }

    pub(crate) fn text(&self, segment: u32) -> PathBuf {
        self.path.join(format!("{segment}.txt"))
    }

    pub(crate) fn pictures(&self, segment: u32) -> PathBuf {
        self.path.join(segment.to_string())
    }

    pub(crate) fn picture(&self, segment: u32, frame: u64) -> PathBuf {
        self.pictures(segment).join(format!("{frame}.png"))
    }

    /// Another file of a frame: a picture's channel, `depth` or `ids`, or the picture of a hand camera of this name.
    pub(crate) fn channel(&self, segment: u32, frame: u64, name: &str) -> PathBuf {
        self.pictures(segment).join(format!("{frame}.{name}.png"))
    }

    /// The file of the intention to change its files.
    pub(crate) fn intent(&self) -> PathBuf {
        self.path.join(".intent.json")
    }

    /// The folder of what was undone and can be redone.
    pub(crate) fn undone(&self) -> Self {
        Self::at(&self.path.join(".undone"), &self.storage)
    }

    /// The folder of what was undone and cannot be redone any more, on its way out.
    pub(crate) fn dropped(&self) -> Self {
        Self::at(&self.path.join(".dropped"), &self.storage)
    }

    /// The folder of what was undone with a segment.
    pub(crate) fn undone_segment(&self, segment: u32) -> Self {
        Self::at(&self.undone().pictures(segment), &self.storage)
    }

    /// The folder of what was undone with a segment. It must be there, and no link to another.
    pub(crate) fn require_undone_segment(&self, segment: u32) -> Result<Self, RecorderError> {
        let undone_segment = self.undone_segment(segment);
        for folder in [&self.undone().path, &undone_segment.path] {
            require_folder(folder).map_err(RecorderError::read(folder))?;
        }
        Ok(undone_segment)
    }

    /// Moves text and pictures of a segment to another folder, unless they are already there.
    pub(crate) fn move_segment(&self, segment: u32, to: &Self) -> Result<(), RecorderError> {
        for (from, to) in [
            (self.pictures(segment), to.pictures(segment)),
            (self.text(segment), to.text(segment)),
        ] {
            if is_taken(&from) {
                let moved = self.storage.rename(&from, &to);
                moved.map_err(RecorderError::write(&from))?;
            }
        }
        Ok(())
    }

    /// Removes the pictures of a segment, and their channels, from this frame on.
    pub(crate) fn remove_pictures(&self, segment: u32, first: u64) -> Result<(), RecorderError> {
        for (frame, path) in self.pictured_frames(segment)? {
            if frame >= first {
                self.storage
                    .remove_file(&path)
                    .map_err(RecorderError::write(&path))?;
            }
        }
        Ok(())
    }

    /// The frames of a segment that are in pictures or their channels, each with the file.
    pub(crate) fn pictured_frames(
        &self,
        segment: u32,
    ) -> Result<Vec<(u64, PathBuf)>, RecorderError> {
        let folder = self.pictures(segment);
        let mut frames = Vec::new();
        if !is_taken(&folder) {
            return Ok(frames);
        }
        require_folder(&folder).map_err(RecorderError::read(&folder))?;
        let entries = self.storage.entries(&folder);
        for path in entries.map_err(RecorderError::read(&folder))? {
            let name = path.file_name().and_then(|name| name.to_str());
            let frame = name.and_then(|name| name.split('.').next()?.parse().ok());
            frames.extend(frame.map(|frame| (frame, path)));
        }
        Ok(frames)
    }

    /// Removes the folder, if there is one. It is gone at once, if not yet from the disk.
    pub(crate) fn remove(&self) -> Result<(), RecorderError> {
        match self.storage.remove_folder(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(RecorderError::write(&self.path)(error))
            }
            _ => Ok(()),
        }
    }

    /// Makes its files outlive a loss of power.
    pub(crate) fn sync(&self) -> Result<(), RecorderError> {
        let synced = self.storage.sync_tree(&self.path);
        synced.map_err(RecorderError::write(&self.path))
    }

    /// Makes its name outlive a loss of power.
    pub(crate) fn sync_name(&self) -> Result<(), RecorderError> {
        let synced = self.storage.sync_folder(parent_of(&self.path));
        synced.map_err(RecorderError::write(&self.path))
    }

    /// Makes a folder in it, or keeps the one that is there.
    pub(crate) fn create_inner(&self, path: &Path) -> Result<(), RecorderError> {
        let made = self.storage.create_folders(path);
        made.map_err(RecorderError::create(path))
    }
}

fn parent_of(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| *parent != Path::new(""));
    parent.unwrap_or(Path::new("."))
}

/// Keeps others from starting a recording in the same folder at the same moment, as long as it is there.
struct Starters {
    _locked: File,
}

impl Starters {
    /// Waits for others; not for long, and not where a file system knows no locks.
    fn wait_for(parent: &Path) -> Option<Self> {
        let locked = File::open(parent).ok()?;
        for _ in 0..200 {
            match locked.try_lock() {
                Ok(()) => return Some(Self { _locked: locked }),
                Err(fs::TryLockError::WouldBlock) => sleep(Duration::from_millis(10)),
                Err(fs::TryLockError::Error(_)) => return None,
            }
        }
        None
    }
}

fn first_free_name(path: &Path) -> PathBuf {
    let numbered = |number: u32| {
        let mut name = path.components().as_path().as_os_str().to_owned();
        name.push(format!("-{number}"));
        PathBuf::from(name)
    };
    let mut number = 1;
    while is_taken(&numbered(number)) {
        number += 1;
    }
    numbered(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(unix)]
    use crate::files::log_file::LogFile;

    #[test]
    fn earlier_recordings_are_moved_aside_to_the_first_free_number() {
        let parent = std::env::temp_dir().join(format!("tabletop_folder_{}", std::process::id()));
        let demo = parent.join("demo/");
        let storage = Storage::default();
        for content in ["first", "second", "third"] {
            let fill = |folder: &Folder| {
                fs::write(folder.path().join("content"), content).unwrap();
                Ok(())
            };
            Folder::create(&demo, &storage, fill, |_, ()| Ok(())).unwrap();
        }
        let full = || RecorderError::write(&demo)(io::Error::other("full"));
        let unfilled = Folder::create(&demo, &storage, |_| Err::<(), _>(full()), |_, ()| Ok(()));
        unfilled.unwrap_err();
        let unopened = Folder::create(&demo, &storage, |_| Ok(()), |_, ()| Err::<(), _>(full()));
        unopened.unwrap_err();
        assert_eq!(
            fs::read_dir(&parent).unwrap().count(),
            3,
            "nothing is left of these"
        );
        for (folder, content) in [("demo", "third"), ("demo-1", "first"), ("demo-2", "second")] {
            let path = parent.join(folder).join("content");
            assert_eq!(fs::read_to_string(path).unwrap(), content);
        }
        fs::remove_dir_all(parent).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_is_being_recorded_and_what_is_no_recording_stays_where_it_is() {
        let demo = std::env::temp_dir().join(format!("tabletop_locked_{}", std::process::id()));
        let storage = Storage::default();
        let begin = || {
            let fill = |folder: &Folder| LogFile::create(&storage, folder.session());
            Folder::create(&demo, &storage, fill, |_, session| {
                session.lock();
                Ok(session)
            })
        };
        let session = begin().unwrap();
        let error = begin().unwrap_err().to_string();
        assert!(error.starts_with("a recording is being made in"), "{error}");
        drop(session);
        drop(begin().unwrap());
        let file = demo.join("session.jsonl");
        let error = Folder::create(&file, &storage, |_| Ok(()), |_, ()| Ok(()));
        let error = error.unwrap_err().to_string();
        assert!(
            error.ends_with("is a file; record into a folder"),
            "{error}"
        );
        assert!(file.exists());
        for folder in [demo.clone(), PathBuf::from(format!("{}-1", demo.display()))] {
            fs::remove_dir_all(folder).unwrap();
        }
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let error = Folder::create(
            Path::new("/dev/null/demo"),
            &Storage::default(),
            |_| Ok(()),
            |_, ()| Ok(()),
        )
        .unwrap_err();
        assert!(error.to_string().contains("/dev/null/demo"), "{error}");
    }
}
