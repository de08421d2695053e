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
mod shards;
mod tf_features;

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};
use tabletop_storage::{InnerFile, InnerPath, Storage, WriterLock};
use tabletop_training::TrainingEpisode;

use self::{
    example::record_of,
    shards::{Shards, shard_path},
    tf_features::features_of,
};
use crate::{error::ExportError, format::DatasetFormat};

const INFO: &str = "dataset_info.json";
const FEATURES: &str = "features.json";

/// The split that gets the episodes, the kind of its files, and their names.
const TRAIN: &str = "train";
const FORMAT: &str = "tfrecord";
const TEMPLATE: &str = "{DATASET}-{SPLIT}.{FILEFORMAT}-{SHARD_INDEX}";

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
    /// The file as it was read, with everything that others have written into it.
    info: Option<Value>,
    /// Number of episodes in each file.
    shards: Vec<u64>,
    bytes: u64,
    /// The records that are not yet in a file, and their number.
    waiting: (Vec<u8>, u64),
    /// Nobody else writes to it meanwhile.
    _lock: WriterLock,
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
    /// Another program writes there and the storage is not to wait for it; or the folder holds anything else, or cannot be read or written.
    pub fn open(folder: PathBuf, storage: &Storage) -> Result<Self, ExportError> {
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let lock = WriterLock::of_folder(&folder, storage).map_err(ExportError::io(&folder))?;
        let name = name_of(&folder);
        let info = read_json(&folder, INFO)?;
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
        let (name, shards) = match &info {
            Some(info) => known(info, &folder)?,
            None => (name, Shards::default()),
        };
        Ok(Self {
            name,
            features: read_json(&folder, FEATURES)?.filter(|_| info.is_some()),
            info,
            folder,
            storage: storage.clone(),
            shards: shards.episodes,
            bytes: shards.bytes,
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
        let file = shard_path(&self.name, self.shards.len());
        let file = file.map_err(|error| ExportError::dataset(&self.folder, error))?;
        let path = file.below(&self.folder);
        self.storage
            .replace_name(&path, &records)
            .map_err(ExportError::io(&path))?;
        self.shards.push(count);
        self.bytes += records.len() as u64;
        Ok(())
    }

    /// The present `dataset_info.json`: of one that was there, all but the files of the split `train` stays.
    fn info(&self) -> Value {
        let mut info = self.info.clone().unwrap_or_else(|| {
            json!({
                "name": self.name,
                "version": "1.0.0",
                "description": "Demonstrations of the tabletop simulator, as RLDS episodes.",
                "fileFormat": FORMAT,
                "releaseNotes": { "1.0.0": "Initial release." },
                "splits": [{ "name": TRAIN, "filepathTemplate": TEMPLATE }],
            })
        });
        let splits = info["splits"].as_array_mut().into_iter().flatten();
        for train in splits.filter(|split| split["name"] == TRAIN) {
            let lengths: Vec<_> = self.shards.iter().map(u64::to_string).collect();
            train["shardLengths"] = json!(lengths);
            train["numBytes"] = json!(self.bytes.to_string());
        }
        info
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
            let path = InnerPath::fixed(name).below(&self.folder);
            let text = serde_json::to_vec_pretty(&value)
                .map_err(|error| ExportError::dataset(&path, error))?;
            self.storage
                .replace_name(&path, &text)
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

fn read_json(folder: &Path, name: &'static str) -> Result<Option<Value>, ExportError> {
    let file = InnerFile::new(folder, InnerPath::fixed(name));
    let path = &file.path();
    match file.read(MOST_BYTES) {
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

/// The name of a dataset that is there, and what is in the files of its split `train`.
fn known(info: &Value, folder: &Path) -> Result<(String, Shards), ExportError> {
    let fault = |problem: String| {
        let path = InnerPath::fixed(INFO).below(folder);
        ExportError::dataset(path, problem)
    };
    let name = info["name"].as_str().filter(|name| is_name(name));
    let name = name.ok_or_else(|| {
        let name = &info["name"];
        fault(format!(
            "its name is {name}, expected a lower-case letter, then letters, digits and _"
        ))
    })?;
    let lengths = lengths_of(info).map_err(fault)?;
    let shards = Shards::count(folder, name, lengths.len())?;
    match shards.episodes == lengths {
        true => Ok((name.to_owned(), shards)),
        false => Err(fault(format!(
            "it says that its files have {lengths:?} episodes, and they have {:?}",
            shards.episodes
        ))),
    }
}

/// The number of episodes in each file, as it is said; or why no episodes can be added.
fn lengths_of(info: &Value) -> Result<Vec<u64>, String> {
    if info["fileFormat"] != FORMAT {
        let format = &info["fileFormat"];
        return Err(format!("its files are {format}, expected {FORMAT:?}"));
    }
    let splits = info["splits"].as_array().into_iter().flatten();
    let mut trains = splits.filter(|split| split["name"] == TRAIN);
    let train = trains.next().ok_or("it has no split train")?;
    if train["filepathTemplate"] != TEMPLATE {
        let template = &train["filepathTemplate"];
        return Err(format!(
            "the files of its split train are named {template}, expected {TEMPLATE:?}"
        ));
    }
    let number = |length: &Value| length.as_str()?.parse().ok();
    let lengths = train["shardLengths"].as_array();
    let lengths = lengths.and_then(|lengths| lengths.iter().map(number).collect());
    lengths.ok_or_else(|| "its split train has no shardLengths".into())
}

/// True for a name that TensorFlow Datasets allows.
fn is_name(name: &str) -> bool {
    let is_of_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    name.starts_with(|first: char| first.is_ascii_lowercase()) && name.chars().all(is_of_name)
}
