//! Formats of a file an episode.

use std::{
    fmt::Display,
    marker::PhantomData,
    path::{Path, PathBuf},
};

use tabletop_storage::{InnerPath, Storage, WriterLock, is_taken};
use tabletop_training::TrainingEpisode;

use crate::{error::ExportError, format::DatasetFormat};

/// A kind of file that holds an episode.
pub trait EpisodeFile {
    /// The end of its name, with the dot.
    const ENDING: &'static str;

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
    /// Nobody else writes to it meanwhile.
    _lock: WriterLock,
}

impl<F: EpisodeFile> EpisodeFiles<F> {
    /// The folder; episodes that it has already stay.
    ///
    /// # Errors
    /// Another program writes there and the storage is not to wait for it; or it holds anything else, or cannot be read or written.
    pub fn open(folder: PathBuf, storage: &Storage) -> Result<Self, ExportError> {
        require_own(&folder, F::ENDING, storage)?;
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let lock = WriterLock::of_folder(&folder, storage).map_err(ExportError::io(&folder))?;
        // Meanwhile, another format's export may have been there.
        require_own(&folder, F::ENDING, storage)?;
        let mut files = Self {
            folder,
            next: 0,
            storage: storage.clone(),
            kind: PhantomData,
            _lock: lock,
        };
        while is_taken(&files.path()) {
            files.next += 1;
        }
        Ok(files)
    }

    fn path(&self) -> PathBuf {
        InnerPath::padded("episode-", 6, self.next as u64, F::ENDING).below(&self.folder)
    }
}

/// Makes sure that a folder is missing or empty, or has episodes of this kind.
fn require_own(folder: &Path, ending: &str, storage: &Storage) -> Result<(), ExportError> {
    if !is_taken(folder) {
        return Ok(());
    }
    let entries = storage.entries(folder).map_err(ExportError::io(folder))?;
    let is_hidden = |name: &str| name.starts_with('.');
    let is_episode = |name: &str| {
        let number = name.strip_prefix("episode-");
        let number = number.and_then(|rest| rest.strip_suffix(ending));
        number.is_some_and(|number| number.bytes().all(|digit| digit.is_ascii_digit()))
    };
    let names = entries
        .iter()
        .filter_map(|entry| entry.file_name()?.to_str());
    let names: Vec<_> = names.collect();
    match names.iter().any(|name| is_episode(name)) || names.iter().all(|name| is_hidden(name)) {
        true => Ok(()),
        false => Err(ExportError::dataset(
            folder,
            format!("it is neither empty nor a folder of episodes in {ending} files"),
        )),
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
