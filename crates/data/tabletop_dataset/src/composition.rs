//! Datasets made of the whole episodes of others.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use tabletop_export::{DatasetFormat as _, LeRobot, LeRobotReader};
use tabletop_recorder::RecordingReader;
use tabletop_storage::{InnerPath, Storage};
use tabletop_training::TrainingEpisode;

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder, inner_name, name_of},
    new_folder::make_folder,
};

/// A part of a dataset: the folder below the new one, none for that itself, and the numbers of its episodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DatasetPart {
    /// The name of its folder.
    pub name: Option<InnerPath>,
    /// The numbers of its episodes, from 0.
    pub episodes: BTreeSet<usize>,
}

/// Makes one dataset of several of one kind: their episodes, in order.
///
/// # Errors
/// Another program writes to it and the storage is not to wait for that; they are of different kinds, or do not fit together; or something cannot be read or written. Then there is no new folder.
pub fn merge(
    sources: &[DatasetFolder],
    out: &Path,
    storage: &Storage,
) -> Result<usize, DatasetError> {
    let all = sources.iter().map(DatasetFolder::episodes).sum();
    let whole = DatasetPart {
        name: None,
        episodes: (0..all).collect(),
    };
    divide(sources, out, &[whole], storage)?;
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
    storage: &Storage,
) -> Result<(), DatasetError> {
    if let Some(empty) = parts.iter().find(|part| part.episodes.is_empty()) {
        let name = empty.name.as_ref().map(InnerPath::as_path);
        let name = name.unwrap_or(Path::new("it")).display();
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
    make_folder(out, storage, |folder| {
        for part in parts {
            let place = match &part.name {
                Some(name) => name.below(folder),
                None => folder.to_owned(),
            };
            match datasets.is_empty() {
                true => copy(&recordings, part, &place, storage)?,
                false => write(&datasets, part, place, storage)?,
            }
        }
        Ok(())
    })
}

/// Copies whole recordings into a folder.
fn copy(
    recordings: &[PathBuf],
    part: &DatasetPart,
    place: &Path,
    storage: &Storage,
) -> Result<(), DatasetError> {
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
            true => inner_name(recording)?,
            false => InnerPath::padded("", 4, number as u64, ""),
        };
        let copied = storage.copy_folder(recording, &name.below(place));
        copied.map_err(DatasetError::io(place))?;
    }
    Ok(())
}

/// Writes episodes of datasets as a new one.
fn write(
    datasets: &[&LeRobotReader],
    part: &DatasetPart,
    place: PathBuf,
    storage: &Storage,
) -> Result<(), DatasetError> {
    let mut first = 0;
    let chosen = datasets.iter().map(|dataset| {
        let numbers = first..first + dataset.episodes();
        first = numbers.end;
        let chosen = numbers.map(|number| part.episodes.contains(&number));
        (*dataset, chosen.collect::<Vec<_>>())
    });
    let chosen = chosen.collect::<Vec<_>>();
    write_dataset(place, chosen, storage, |episode| Ok(Some(episode)))
}

/// Writes those episodes of datasets that are chosen and that `change` keeps.
pub(crate) fn write_dataset(
    place: PathBuf,
    datasets: Vec<(&LeRobotReader, Vec<bool>)>,
    storage: &Storage,
    mut change: impl FnMut(TrainingEpisode) -> Result<Option<TrainingEpisode>, DatasetError>,
) -> Result<(), DatasetError> {
    let has_language = datasets.iter().all(|(dataset, _)| dataset.has_language());
    let mut written = LeRobot::open(place, storage)?;
    if has_language {
        written = written.with_language();
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
