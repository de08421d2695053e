//! Folders that are datasets: of recordings, or in the format of LeRobot.

use std::path::{Path, PathBuf};

use tabletop_export::LeRobotReader;
use tabletop_storage::{Storage, is_taken};

use crate::error::DatasetError;

/// A folder that is a dataset.
#[derive(Clone, Debug)]
pub struct DatasetFolder {
    /// Its path.
    pub path: PathBuf,
    /// Its content.
    pub content: DatasetContent,
}

/// The content of a dataset.
#[derive(Clone, Debug)]
pub enum DatasetContent {
    /// The folders of recordings, numbers in their order.
    Recordings(Vec<PathBuf>),
    /// A dataset that was exported for LeRobot.
    LeRobot(Box<LeRobotReader>),
}

impl DatasetFolder {
    /// Opens a recording, a folder of recordings, or a LeRobot dataset.
    ///
    /// # Errors
    /// It is none of them, or cannot be read.
    pub fn open(path: &Path) -> Result<Self, DatasetError> {
        let content = match is_taken(&path.join("meta")) {
            true => DatasetContent::LeRobot(Box::new(LeRobotReader::open(path)?)),
            false => DatasetContent::Recordings(recordings_in(path)?),
        };
        Ok(Self {
            path: path.to_owned(),
            content,
        })
    }

    /// Number of its episodes.
    pub fn episodes(&self) -> usize {
        match &self.content {
            DatasetContent::Recordings(recordings) => recordings.len(),
            DatasetContent::LeRobot(dataset) => dataset.episodes(),
        }
    }
}

/// The recordings in a folder, which may be one itself.
fn recordings_in(folder: &Path) -> Result<Vec<PathBuf>, DatasetError> {
    let is_recording = |folder: &Path| is_taken(&folder.join("session.jsonl"));
    if is_recording(folder) {
        return Ok(vec![folder.to_owned()]);
    }
    let entries = Storage::default().entries(folder);
    let mut recordings = entries.map_err(|error| DatasetError::unfit(folder, error))?;
    recordings.retain(|path| !name_of(path).starts_with('.') && is_recording(path));
    recordings.sort_by_key(|path| {
        let name = name_of(path);
        (name.parse().unwrap_or(u64::MAX), name)
    });
    match recordings.is_empty() {
        true => Err(DatasetError::unfit(
            folder,
            "it is neither a recording, nor a folder of recordings, nor a LeRobot dataset",
        )),
        false => Ok(recordings),
    }
}

/// The last part of a path.
pub(crate) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
