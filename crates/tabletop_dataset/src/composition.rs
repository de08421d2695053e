//! Datasets made of the whole episodes of others.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use tabletop_export::{DatasetFormat as _, LeRobot, LeRobotReader, TrainingEpisode};
use tabletop_recorder::RecordingReader;
use tabletop_storage::Storage;

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder, name_of},
    new_folder::make_folder,
};

/// A part of a dataset: the folder below the new one, none for that itself, and the numbers of its episodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DatasetPart {
    /// The name of its folder.
    pub name: Option<String>,
    /// The numbers of its episodes, from 0.
    pub episodes: BTreeSet<usize>,
}

/// Makes one dataset of several of one kind: their episodes, in order.
///
/// # Errors
/// They are of different kinds, or do not fit together; or something cannot be read or written. Then there is no new folder.
pub fn merge(sources: &[DatasetFolder], out: &Path) -> Result<usize, DatasetError> {
    let all = sources.iter().map(DatasetFolder::episodes).sum();
    let whole = DatasetPart {
        name: None,
        episodes: (0..all).collect(),
    };
    divide(sources, out, &[whole])?;
    Ok(all)
}

/// Makes a folder with parts of datasets of one kind, whose episodes are numbered through. The sources stay as they are.
///
/// # Errors
/// As [`merge`]; or a part has no episode.
pub fn divide(
    sources: &[DatasetFolder],
    out: &Path,
    parts: &[DatasetPart],
) -> Result<(), DatasetError> {
    if let Some(empty) = parts.iter().find(|part| part.episodes.is_empty()) {
        let name = empty.name.as_deref().unwrap_or("it");
        return Err(DatasetError::unfit(
            out,
            format!("{name} would have no episode"),
        ));
    }
    let (mut recordings, mut datasets) = (Vec::new(), Vec::new());
    for source in sources {
        match &source.content {
            DatasetContent::Recordings(folders) => recordings.extend(folders.iter().cloned()),
            DatasetContent::LeRobot(dataset) => datasets.push(&**dataset),
        }
    }
    if !recordings.is_empty() && !datasets.is_empty() {
        let problem = "recordings and LeRobot datasets cannot be one; export the recordings first";
        return Err(DatasetError::unfit(out, problem));
    }
    make_folder(out, |folder| {
        for part in parts {
            let place = match &part.name {
                Some(name) => folder.join(name),
                None => folder.to_owned(),
            };
            match datasets.is_empty() {
                true => copy(&recordings, part, &place)?,
                false => write(&datasets, part, place)?,
            }
        }
        Ok(())
    })
}

/// Copies whole recordings into a folder.
fn copy(recordings: &[PathBuf], part: &DatasetPart, place: &Path) -> Result<(), DatasetError> {
    let storage = Storage::default();
    let made = storage.create_folders(place);
    made.map_err(DatasetError::io(place))?;
    let chosen = part
        .episodes
        .iter()
        .filter_map(|&number| recordings.get(number));
    let chosen: Vec<_> = chosen.collect();
    let names: BTreeSet<_> = chosen.iter().map(|path| name_of(path)).collect();
    let are_unique = names.len() == chosen.len();
    for (number, recording) in chosen.into_iter().enumerate() {
        // What was interrupted in it is finished before it is copied.
        RecordingReader::open(recording)?;
        let name = match are_unique {
            true => name_of(recording),
            false => format!("{number:04}"),
        };
        let copied = storage.copy_folder(recording, &place.join(name));
        copied.map_err(DatasetError::io(place))?;
    }
    Ok(())
}

/// Writes episodes of datasets as a new one.
fn write(
    datasets: &[&LeRobotReader],
    part: &DatasetPart,
    place: PathBuf,
) -> Result<(), DatasetError> {
    let mut first = 0;
    let chosen = datasets.iter().map(|dataset| {
        let numbers = first..first + dataset.episodes();
        first = numbers.end;
        let chosen = numbers.map(|number| part.episodes.contains(&number));
        (*dataset, chosen.collect::<Vec<_>>())
    });
    write_dataset(place, chosen.collect::<Vec<_>>(), |episode| {
        Ok(Some(episode))
    })
}

/// Writes those episodes of datasets that are chosen and that `change` keeps.
pub(crate) fn write_dataset(
    place: PathBuf,
    datasets: Vec<(&LeRobotReader, Vec<bool>)>,
    mut change: impl FnMut(TrainingEpisode) -> Result<Option<TrainingEpisode>, DatasetError>,
) -> Result<(), DatasetError> {
    let has_language = datasets.iter().all(|(dataset, _)| dataset.has_language());
    let mut written = LeRobot::open(place)?;
    if !has_language {
        written = written.without_language();
    }
    for (dataset, chosen) in datasets {
        let mut chosen = chosen.into_iter();
        dataset.visit(|episode| {
            if chosen.next().unwrap_or(false)
                && let Some(episode) = change(episode)?
            {
                written.write(LeRobot::prepare(episode)?)?;
            }
            Ok::<_, DatasetError>(())
        })?;
    }
    Ok(written.finish()?)
}
