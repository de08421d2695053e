//! What is told of a recording that is not open.

use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

use tabletop_storage::Storage;
use tabletop_task::{Demonstration, Requirements, Task};
use tabletop_user::RecordingDigest;

use tabletop_recorder::{NOTES, RecordingReader, read_notes};

/// The file that makes a folder a recording.
const SESSION: &str = "session.jsonl";

/// The times at which the files that a digest is made of were changed.
pub(super) type Stamp = [Option<SystemTime>; 3];

/// The folders of the recordings directly in a folder, the last one that was made first.
pub(super) fn recordings_in(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let place = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let entries = Storage::default().entries(place);
    let entries =
        entries.map_err(|error| format!("{} cannot be read: {error}", place.display()))?;
    let is_hidden = |path: &Path| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().starts_with('.')
    };
    let mut recordings: Vec<_> = entries
        .into_iter()
        .filter(|entry| !is_hidden(entry) && entry.join(SESSION).is_file())
        .map(|entry| folder.join(entry.file_name().unwrap_or_default()))
        .collect();
    recordings.sort_by_cached_key(|recording| {
        let [begun, ..] = stamp(recording);
        (std::cmp::Reverse(begun), recording.clone())
    });
    Ok(recordings)
}

pub(super) fn stamp(recording: &Path) -> Stamp {
    [SESSION, NOTES, Requirements::FILE].map(|file| {
        let about = fs::metadata(recording.join(file)).ok()?;
        about.modified().ok()
    })
}

/// Reads what is told of a recording.
pub(super) fn digest(folder: &Path) -> Result<RecordingDigest, String> {
    let said = |error: &dyn std::fmt::Display| error.to_string();
    let recording = RecordingReader::open(folder).map_err(|error| said(&error))?;
    let timeline = recording.timeline().map_err(|error| said(&error))?;
    let shown = Demonstration::of(&recording).map_err(|error| said(&error))?;
    let mut task = Task::of(&shown);
    let requirements = Requirements::read_for(&task, folder).map_err(|error| said(&error))?;
    task.phrase(&requirements);
    Ok(RecordingDigest {
        ticks: timeline.end.0 - timeline.start.0,
        segments: timeline.segments.len(),
        is_finished: recording.cut_off_at().is_none(),
        sentences: task.steps.into_iter().map(|step| step.sentence).collect(),
        notes: read_notes(folder).map_err(|error| said(&error))?,
        picture: timeline.pictures.last().map(|picture| picture.path.clone()),
    })
}
