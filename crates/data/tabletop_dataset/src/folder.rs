//! Folders that are datasets: of recordings, or in the format of LeRobot.

use std::path::{Path, PathBuf};

use tabletop_export::LeRobotReader;
use tabletop_storage::{InnerPath, Storage, is_taken};

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
            false => match recordings_in(path)? {
                recordings if recordings.is_empty() => {
                    let problem = "it is neither a recording, nor a folder of recordings, nor a LeRobot dataset";
                    return Err(DatasetError::unfit(path, problem));
                }
                recordings => DatasetContent::Recordings(recordings),
            },
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

/// The recordings in a folder, which may be one itself, numbers in their order; none if there is none. What is hidden is passed over.
///
/// # Errors
/// The folder cannot be read, or a recording in it is a link, which could lead anywhere.
pub fn recordings_in(folder: &Path) -> Result<Vec<PathBuf>, DatasetError> {
    let is_recording = |folder: &Path| is_taken(&folder.join("session.jsonl"));
    if is_recording(folder) {
        return Ok(vec![folder.to_owned()]);
    }
    let entries = Storage::default().entries(folder);
    let mut recordings = entries.map_err(|error| DatasetError::unfit(folder, error))?;
    recordings.retain(|path| !name_of(path).starts_with('.') && is_recording(path));
    if let Some(link) = recordings.iter().find(|path| path.is_symlink()) {
        let problem = "it is a link, which could lead anywhere; name what it leads to instead";
        return Err(DatasetError::unfit(link, problem));
    }
    recordings.sort_by_key(|path| {
        let name = name_of(path);
        (name.parse().unwrap_or(u64::MAX), name)
    });
    Ok(recordings)
}

/// The name of a recording, for its copy.
pub(crate) fn inner_name(recording: &Path) -> Result<InnerPath, DatasetError> {
    let path = std::path::absolute(recording).map_err(DatasetError::io(recording))?;
    let name = InnerPath::name(path.file_name().unwrap_or_default());
    name.map_err(|error| DatasetError::unfit(recording, error))
}

/// The last part of a path.
pub(crate) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
