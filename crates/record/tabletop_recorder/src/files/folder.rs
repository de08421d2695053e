//! The files of a recording.

use std::{
    io,
    path::{Path, PathBuf},
};

use tabletop_storage::{InnerFile, InnerPath, Storage, is_taken, parent_of, require_folder};

use crate::error::RecorderError;

/// The folder of a recording.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    storage: Storage,
}

impl Folder {
    pub(crate) fn existing(path: &Path) -> Self {
        Self::at(path, &Storage::default())
    }

    pub(crate) fn at(path: &Path, storage: &Storage) -> Self {
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
        InnerPath::numbered("", segment, ".txt").below(&self.path)
    }

    pub(crate) fn pictures(&self, segment: u32) -> PathBuf {
        InnerPath::numbered("", segment, "").below(&self.path)
    }

    pub(crate) fn picture(&self, segment: u32, frame: u64) -> PathBuf {
        self.picture_file(segment, frame).path()
    }

    /// The head camera's picture of a frame, to be read.
    pub(crate) fn picture_file(&self, segment: u32, frame: u64) -> InnerFile {
        self.file(segment, &InnerPath::numbered("", frame, ".png"))
    }

    /// Another file of a frame: a picture's channel, `depth` or `ids`, or the picture of a hand camera of this name.
    pub(crate) fn channel(
        &self,
        segment: u32,
        frame: u64,
        name: &str,
    ) -> Result<InnerFile, RecorderError> {
        match InnerPath::name(format!("{frame}.{name}.png")) {
            Ok(channel) => Ok(self.file(segment, &channel)),
            Err(error) => Err(RecorderError::Unfit {
                problem: error.to_string(),
            }),
        }
    }

    /// A file in the folder of a segment's pictures.
    fn file(&self, segment: u32, name: &InnerPath) -> InnerFile {
        let pictures = InnerPath::numbered("", segment, "");
        InnerFile::new(&self.path, pictures.then(name))
    }

    /// The file of the intention to change its files.
    pub(crate) fn intent(&self) -> PathBuf {
        self.path.join(".intent.json")
    }

    /// The folder of undone segments that can be redone.
    pub(crate) fn undone(&self) -> Self {
        Self::at(&self.path.join(".undone"), &self.storage)
    }

    /// The folder of undone segments that cannot be redone any more, about to be removed.
    pub(crate) fn dropped(&self) -> Self {
        Self::at(&self.path.join(".dropped"), &self.storage)
    }

    /// The folder of what was undone with a segment.
    pub(crate) fn undone_segment(&self, segment: u32) -> Self {
        Self::at(&self.undone().pictures(segment), &self.storage)
    }

    /// The folder of the files of an undone segment. It must exist, and be no link to another.
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
