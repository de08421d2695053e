//! Whether a dataset is whole, plausible and free of duplicates.

mod endurance;
mod files;
mod finding;
mod poses;

pub use finding::Finding;

use std::{
    collections::{BTreeMap, BTreeSet},
    hash::{DefaultHasher, Hash as _, Hasher as _},
    path::{Path, PathBuf},
};

use tabletop_export::DatasetVideos;
use tabletop_recorder::RecordingReader;
use tabletop_storage::Storage;
use tabletop_task::{Demonstration, Task};

use crate::{
    check::{
        endurance::outlived,
        files::compare_files,
        finding::Findings,
        poses::{jumps_between_frames, jumps_between_ticks},
    },
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder},
    limits::MOST_COMPARED_BYTES,
};

/// The parts of a check that take long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckOptions {
    /// Whether recordings are simulated to their ends and on, to see whether what was done lasts.
    pub simulates: bool,
}

/// Checks a dataset. `tell` hears of every episode that was checked.
///
/// # Errors
/// The folder itself cannot be read. What is wrong with an episode is a finding.
pub fn check(
    dataset: &DatasetFolder,
    options: CheckOptions,
    mut tell: impl FnMut(usize),
) -> Result<Vec<Finding>, DatasetError> {
    let mut findings = Findings::default();
    let mut contents = Duplicates::default();
    match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            for (number, folder) in recordings.iter().enumerate() {
                findings.place = folder.clone();
                if let Err(error) = check_recording(folder, options, &mut findings) {
                    findings.add(error);
                }
                contents.add(folder, content_of(folder), &mut findings);
                tell(number + 1);
            }
        }
        DatasetContent::LeRobot(reader) => {
            findings.place.clone_from(&dataset.path);
            let mut episodes = 0;
            let mut videos = match reader.videos() {
                Ok(videos) => Some(videos),
                Err(error) => {
                    findings.add(error);
                    None
                }
            };
            let mut faults = BTreeSet::new();
            let visited = reader.visit_tables(|number, episode| {
                episodes += 1;
                let of_videos = videos.iter_mut();
                for fault in of_videos.flat_map(|it| it.faults(number, episode.len())) {
                    // That of a whole video is that of all its episodes.
                    let fault = fault.to_string();
                    if faults.insert(fault.clone()) {
                        findings.place.clone_from(&dataset.path);
                        findings.add(fault);
                    }
                }
                findings.place.clone_from(&episode.folder);
                find_no_words(&episode.task, &mut findings);
                jumps_between_frames(&episode, &mut findings);
                let state = episode.whole_state();
                let values = state.values.iter().chain(&episode.action.values);
                let numbers: Vec<u8> = values
                    .flat_map(|value| value.to_bits().to_le_bytes())
                    .collect();
                contents.add(&episode.folder, Some(numbers), &mut findings);
                tell(episodes);
                Ok::<_, DatasetError>(())
            });
            findings.place.clone_from(&dataset.path);
            if let Err(error) = visited {
                findings.add(error);
            }
            for stray in videos.iter_mut().flat_map(DatasetVideos::strays) {
                findings.add(stray);
            }
            if let Some(contradiction) = reader.contradiction() {
                findings.add(contradiction);
            }
        }
    }
    Ok(findings.found)
}

fn check_recording(
    folder: &Path,
    options: CheckOptions,
    findings: &mut Findings,
) -> Result<(), DatasetError> {
    let recording = RecordingReader::open(folder)?;
    if let Some(tick) = recording.cut_off_at() {
        findings.add(format!(
            "it was cut off in tick {}; `tabletop replay {} --out NEW` makes a complete one of it",
            tick.0,
            folder.display()
        ));
    }
    let task = Task::of(&Demonstration::of(&recording)?);
    find_no_words(&task.instruction(), findings);
    compare_files(&recording, findings)?;
    jumps_between_ticks(&recording.states()?, findings);
    if options.simulates && !recording.header().is_imported() {
        outlived(&recording, findings)?;
    }
    Ok(())
}

/// Finds a task without words: nothing is done, so there is nothing to learn.
fn find_no_words(task: &str, findings: &mut Findings) {
    if task.is_empty() {
        findings.add("its task is empty: nothing is moved for good");
    }
}

/// The states of a recording, which two that are the same have in common.
fn content_of(folder: &Path) -> Option<Vec<u8>> {
    let path = folder.join("states.csv");
    Storage::default().read(&path, MOST_COMPARED_BYTES).ok()
}

/// The contents of episodes, by their hashes.
#[derive(Debug, Default)]
struct Duplicates(BTreeMap<(usize, u64), PathBuf>);

impl Duplicates {
    fn add(&mut self, place: &Path, content: Option<Vec<u8>>, findings: &mut Findings) {
        let Some(content) = content else {
            return;
        };
        let mut hasher = DefaultHasher::new();
        content.hash(&mut hasher);
        let first = self.0.entry((content.len(), hasher.finish()));
        let first = first.or_insert_with(|| place.to_owned());
        if first != place {
            let problem = format!("it is the same as {}", first.display());
            findings.place = place.to_owned();
            findings.add(problem);
        }
    }
}
