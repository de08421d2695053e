//! What a dataset consists of.

use std::{
    collections::{BTreeMap, BTreeSet},
    io,
    path::Path,
};

use tabletop_core::TICKS_PER_SECOND;
use tabletop_recorder::RecordingReader;
use tabletop_storage::Storage;
use tabletop_task::{Demonstration, Requirements, Task};

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder},
};

/// What a dataset consists of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DatasetSummary {
    /// Its kind, in words.
    pub kind: &'static str,
    /// Number of episodes.
    pub episodes: usize,
    /// Number of frames, of all episodes.
    pub frames: u64,
    /// Simulated seconds, of all episodes.
    pub seconds: f64,
    /// The tasks, with the number of episodes of each, where it is known.
    pub tasks: BTreeMap<String, Option<usize>>,
    /// The ids of the objects.
    pub objects: BTreeSet<String>,
    /// The cameras with pictures.
    pub cameras: BTreeSet<String>,
    /// Size of all files, in bytes.
    pub bytes: u64,
    /// Number of recordings that were imported from another program.
    pub imported: usize,
    /// Number of recordings that were cut off.
    pub cut_off: usize,
    /// What it says of itself that is not so.
    pub contradiction: Option<String>,
}

/// Says what a dataset consists of.
///
/// # Errors
/// A file of it cannot be read.
pub fn summarize(dataset: &DatasetFolder) -> Result<DatasetSummary, DatasetError> {
    let mut summary = DatasetSummary::default();
    match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            summary.kind = "recordings";
            for recording in recordings {
                summary.add(recording)?;
                let bytes = bytes_in(recording);
                summary.bytes += bytes.map_err(DatasetError::io(recording))?;
            }
        }
        DatasetContent::LeRobot(reader) => {
            let frames = reader.frames() as u64;
            let of_objects = reader.state_names().into_iter();
            let objects = of_objects.filter_map(|name| Some(name.strip_suffix(".qx")?.to_owned()));
            let bytes = bytes_in(&dataset.path).map_err(DatasetError::io(&dataset.path))?;
            let tasks = reader.tasks().iter();
            summary = DatasetSummary {
                kind: "LeRobot dataset",
                episodes: reader.episodes(),
                frames,
                seconds: frames as f64 / f64::from(reader.fps()),
                tasks: tasks.map(|task| (task.clone(), None)).collect(),
                objects: objects.collect(),
                cameras: reader.cameras().into_iter().collect(),
                bytes,
                contradiction: reader.contradiction(),
                ..summary
            };
        }
    }
    Ok(summary)
}

impl DatasetSummary {
    fn add(&mut self, folder: &Path) -> Result<(), DatasetError> {
        let recording = RecordingReader::open(folder)?;
        let task = task_of(&recording)?;
        let header = recording.header();
        let ticks = recording.last_tick().0 - recording.first_tick().0;
        self.episodes += 1;
        self.frames += ticks.div_ceil(header.ticks_per_frame.max(1)) + 1;
        self.seconds += ticks as f64 / f64::from(TICKS_PER_SECOND);
        let count = self.tasks.entry(task).or_default();
        *count = Some(count.unwrap_or(0) + 1);
        let objects = recording.session().scene.objects.iter();
        self.objects
            .extend(objects.map(|object| object.spec.id.clone()));
        self.cameras
            .extend(header.camera.map(|_| "head".to_owned()));
        let hands = header.hand_cameras.iter();
        self.cameras.extend(hands.map(|camera| camera.name.clone()));
        self.imported += usize::from(header.is_imported());
        self.cut_off += usize::from(recording.cut_off_at().is_some());
        Ok(())
    }
}

/// The task that a recording shows, in one line.
fn task_of(recording: &RecordingReader) -> Result<String, DatasetError> {
    let mut task = Task::of(&Demonstration::of(recording)?);
    let requirements = Requirements::read_for(&task, recording.folder());
    let folder = recording.folder();
    task.phrase(&requirements.map_err(|error| DatasetError::unfit(folder, error))?);
    Ok(task.instruction())
}

/// The bytes of all files in a folder.
pub(crate) fn bytes_in(folder: &Path) -> io::Result<u64> {
    let storage = Storage::default();
    let mut folders = vec![folder.to_owned()];
    let mut bytes = 0;
    while let Some(folder) = folders.pop() {
        for entry in storage.entries(&folder)? {
            let found = entry.symlink_metadata()?;
            match found.is_dir() {
                true => folders.push(entry),
                false => bytes += found.len(),
            }
        }
    }
    Ok(bytes)
}
