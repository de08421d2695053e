//! Formats of a file an episode.

use std::{fmt::Display, marker::PhantomData, path::PathBuf};

use tabletop_storage::Storage;

use crate::{episode::TrainingEpisode, error::ExportError, format::DatasetFormat};

/// A kind of file that holds an episode.
pub trait EpisodeFile {
    /// The end of its name.
    const EXTENSION: &'static str;

    /// The content of an episode's file.
    ///
    /// # Errors
    /// The format cannot hold it.
    fn content(episode: &TrainingEpisode) -> Result<Vec<u8>, impl Display>;
}

/// A folder with a file an episode: `episode-000000` and so on.
#[derive(Debug)]
pub struct EpisodeFiles<F> {
    folder: PathBuf,
    next: usize,
    storage: Storage,
    kind: PhantomData<F>,
}

impl<F: EpisodeFile> EpisodeFiles<F> {
    /// The folder; episodes that it has already stay.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn open(folder: PathBuf) -> Result<Self, ExportError> {
        let storage = Storage::default();
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let mut files = Self {
            folder,
            next: 0,
            storage,
            kind: PhantomData,
        };
        while files.path().exists() {
            files.next += 1;
        }
        Ok(files)
    }

    fn path(&self) -> PathBuf {
        let name = format!("episode-{:06}.{}", self.next, F::EXTENSION);
        self.folder.join(name)
    }
}

impl<F: EpisodeFile> DatasetFormat for EpisodeFiles<F> {
    /// The content of a file, and the number of its frames.
    type Prepared = (Vec<u8>, usize);

    fn prepare(episode: TrainingEpisode) -> Result<Self::Prepared, ExportError> {
        let content = F::content(&episode).map_err(|error| ExportError::Unfit {
            recording: episode.folder.clone(),
            problem: error.to_string(),
        })?;
        Ok((content, episode.len()))
    }

    fn write(&mut self, (content, frames): Self::Prepared) -> Result<usize, ExportError> {
        let path = self.path();
        self.storage
            .write_new(&path, &content)
            .map_err(ExportError::io(&path))?;
        self.next += 1;
        Ok(frames)
    }

    fn finish(self) -> Result<(), ExportError> {
        Ok(())
    }
}
