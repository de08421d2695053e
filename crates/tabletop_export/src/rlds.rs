//! RLDS: TFRecord files as TensorFlow Datasets reads them, with a record an episode.
//!
//! ```text
//! features.json                       the features of an episode and its steps
//! dataset_info.json                   the files, and the number of episodes in each
//! NAME-train.tfrecord-00000           episodes
//! ```
//!
//! Every export adds files and replaces the two first ones, `dataset_info.json` last: a file that it does not name is no part of the dataset.

mod example;
mod tf_features;

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};
use tabletop_storage::{FolderLock, Storage, Symlinks, read_regular_file};

use self::{example::record_of, tf_features::features_of};
use crate::{episode::TrainingEpisode, error::ExportError, format::DatasetFormat};

const INFO: &str = "dataset_info.json";
const FEATURES: &str = "features.json";

/// Size from which on a file gets no more episodes, in bytes.
const FILE_BYTES: usize = 64_000_000;

/// Largest size of the JSON files, in bytes.
const MOST_BYTES: u64 = 64 * 1024 * 1024;

/// A dataset for TensorFlow Datasets in a folder, to which episodes are added. `tfds.builder_from_directory` opens it.
#[derive(Debug)]
pub struct Rlds {
    folder: PathBuf,
    name: String,
    storage: Storage,
    features: Option<Value>,
    /// Number of episodes in each file.
    shards: Vec<u64>,
    bytes: u64,
    /// The records that are not yet in a file, and their number.
    waiting: (Vec<u8>, u64),
    /// Nobody else writes to it meanwhile.
    _lock: Option<FolderLock>,
}

/// An episode as a record.
#[derive(Debug)]
pub struct EpisodeRecord {
    recording: PathBuf,
    features: Value,
    record: Vec<u8>,
    frames: usize,
}

impl Rlds {
    /// Opens a dataset to add episodes, or begins a new one.
    ///
    /// # Errors
    /// The folder holds anything else, or cannot be read or written.
    pub fn open(folder: PathBuf) -> Result<Self, ExportError> {
        Self::open_in(folder, Storage::default())
    }

    /// [`open`](Self::open) in a storage of which a test lets calls fail.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_in(folder: PathBuf, storage: Storage) -> Result<Self, ExportError> {
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let lock = FolderLock::wait(&folder, &storage);
        let name = name_of(&folder);
        let info = read_json(&folder.join(INFO))?;
        if info.is_none()
            && !storage
                .entries(&folder)
                .map_err(ExportError::io(&folder))?
                .iter()
                .all(|it| is_ours(it, &name))
        {
            return Err(ExportError::dataset(
                &folder,
                "it is neither empty nor an RLDS dataset",
            ));
        }
        let (shards, bytes) = match &info {
            Some(info) => shards_of(info).ok_or_else(|| {
                ExportError::dataset(folder.join(INFO), "it has no split train with shardLengths")
            })?,
            None => (Vec::new(), 0),
        };
        Ok(Self {
            name: info
                .as_ref()
                .and_then(|info| info["name"].as_str())
                .map_or(name, str::to_owned),
            features: read_json(&folder.join(FEATURES))?.filter(|_| info.is_some()),
            folder,
            storage,
            shards,
            bytes,
            waiting: (Vec::new(), 0),
            _lock: lock,
        })
    }

    /// Writes the waiting records to a file of their own.
    fn close_file(&mut self) -> Result<(), ExportError> {
        let (records, count) = std::mem::take(&mut self.waiting);
        if count == 0 {
            return Ok(());
        }
        let name = format!("{}-train.tfrecord-{:05}", self.name, self.shards.len());
        let path = self.folder.join(name);
        self.storage
            .replace(&path, &records)
            .map_err(ExportError::io(&path))?;
        self.shards.push(count);
        self.bytes += records.len() as u64;
        Ok(())
    }

    fn info(&self) -> Value {
        let lengths: Vec<_> = self.shards.iter().map(u64::to_string).collect();
        json!({
            "name": self.name,
            "version": "1.0.0",
            "description": "Demonstrations of the tabletop simulator, as RLDS episodes.",
            "fileFormat": "tfrecord",
            "releaseNotes": { "1.0.0": "Initial release." },
            "splits": [{
                "name": "train",
                "filepathTemplate": "{DATASET}-{SPLIT}.{FILEFORMAT}-{SHARD_INDEX}",
                "numBytes": self.bytes.to_string(),
                "shardLengths": lengths,
            }],
        })
    }
}

impl DatasetFormat for Rlds {
    type Prepared = EpisodeRecord;

    fn prepare(episode: TrainingEpisode) -> Result<EpisodeRecord, ExportError> {
        Ok(EpisodeRecord {
            features: features_of(&episode),
            record: record_of(&episode),
            frames: episode.len(),
            recording: episode.folder,
        })
    }

    fn write(&mut self, episode: EpisodeRecord) -> Result<usize, ExportError> {
        let features = self
            .features
            .get_or_insert_with(|| episode.features.clone());
        if *features != episode.features {
            return Err(ExportError::Unfit {
                recording: episode.recording,
                problem:
                    "its states, actions, cameras or frames a second are not those of the dataset"
                        .into(),
            });
        }
        self.waiting.0.extend(&episode.record);
        self.waiting.1 += 1;
        if self.waiting.0.len() >= FILE_BYTES {
            self.close_file()?;
        }
        Ok(episode.frames)
    }

    fn finish(mut self) -> Result<(), ExportError> {
        self.close_file()?;
        let Some(features) = self.features.take() else {
            return Ok(());
        };
        for (name, value) in [(FEATURES, features), (INFO, self.info())] {
            let path = self.folder.join(name);
            let text = serde_json::to_vec_pretty(&value)
                .map_err(|error| ExportError::dataset(&path, error))?;
            self.storage
                .replace(&path, &text)
                .map_err(ExportError::io(&path))?;
        }
        Ok(())
    }
}

/// The dataset's name, which its files begin with: that of the folder, in the letters that TensorFlow Datasets allows.
fn name_of(folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let allowed = |letter: char| match letter.to_ascii_lowercase() {
        letter @ ('a'..='z' | '0'..='9' | '_') => letter,
        _ => '_',
    };
    let name: String = name.chars().map(allowed).collect();
    match name.starts_with(|first: char| first.is_ascii_lowercase()) {
        true => name,
        false => format!("tabletop_{name}"),
    }
}

/// True for the file of an export that was cut off.
fn is_ours(path: &Path, name: &str) -> bool {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    file == FEATURES
        || file.starts_with('.')
        || file.starts_with(&format!("{name}-train.tfrecord-"))
}

fn read_json(path: &Path) -> Result<Option<Value>, ExportError> {
    match read_regular_file(path, MOST_BYTES, Symlinks::Followed) {
        Ok(bytes) => {
            let value = serde_json::from_slice(&bytes);
            value
                .map(Some)
                .map_err(|error| ExportError::dataset(path, error))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(ExportError::io(path)(error)),
    }
}

/// The number of episodes in each file, and of bytes in all.
fn shards_of(info: &Value) -> Option<(Vec<u64>, u64)> {
    let splits = info["splits"].as_array()?;
    let train = splits.iter().find(|split| split["name"] == "train")?;
    let number = |value: &Value| value.as_str()?.parse().ok();
    let lengths = train["shardLengths"].as_array()?.iter().map(number);
    Some((lengths.collect::<Option<_>>()?, number(&train["numBytes"])?))
}
