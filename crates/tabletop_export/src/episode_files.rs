//! Formats of a file an episode.

use std::path::PathBuf;

use tabletop_storage::Storage;

use crate::error::ExportError;

/// A folder with a file an episode: `episode-000000` and so on.
#[derive(Debug)]
pub(crate) struct EpisodeFiles {
    folder: PathBuf,
    extension: &'static str,
    next: usize,
    storage: Storage,
}

impl EpisodeFiles {
    /// The folder; episodes that it has already stay.
    pub fn open(folder: PathBuf, extension: &'static str) -> Result<Self, ExportError> {
        let storage = Storage::default();
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let mut files = Self {
            folder,
            extension,
            next: 0,
            storage,
        };
        while files.path().exists() {
            files.next += 1;
        }
        Ok(files)
    }

    fn path(&self) -> PathBuf {
        let Self {
            next, extension, ..
        } = self;
        self.folder.join(format!("episode-{next:06}.{extension}"))
    }

    /// Writes the next episode, whole and on the disk.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), ExportError> {
        let path = self.path();
        self.storage
            .write_new(&path, bytes)
            .map_err(ExportError::io(&path))?;
        self.next += 1;
        Ok(())
    }
}
