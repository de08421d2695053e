//! `meta/episodes/chunk-XXX/file-XXX.parquet`: a row an episode.

use std::{collections::BTreeMap, sync::Arc};

use arrow::{array::Int64Array, error::ArrowError};
use parquet::arrow::ArrowWriter;

use super::{
    columns::{self, Column},
    place::DataPlace,
    stats::{FeatureStats, QUANTILES},
    table::{batch, properties},
};
use crate::error::ExportError;

/// An episode in the table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EpisodeRow {
    /// Its number.
    pub number: usize,
    /// Its task.
    pub task: String,
    /// The number of its task.
    pub task_number: usize,
    /// Number of its frames.
    pub frames: usize,
    /// The number of its first frame in the dataset.
    pub first_frame: usize,
    /// The file of its frames.
    pub place: DataPlace,
    /// The parts of videos that show it, by their features.
    pub videos: BTreeMap<String, VideoPart>,
    /// The statistics of its features.
    pub stats: BTreeMap<String, FeatureStats>,
}

/// A part of a video.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct VideoPart {
    /// The video.
    pub place: DataPlace,
    /// Its beginning and end, in s.
    pub times: [f64; 2],
}

/// The table of these episodes, as the file at a place.
pub(super) fn write(rows: &[EpisodeRow], place: DataPlace) -> Result<Vec<u8>, ExportError> {
    table(rows, place)
        .map_err(|error| ExportError::dataset(place.path("meta/episodes", "parquet"), error))
}

fn table(rows: &[EpisodeRow], place: DataPlace) -> Result<Vec<u8>, ArrowError> {
    let tasks: Vec<_> = rows.iter().map(|row| vec![row.task.as_str()]).collect();
    let number =
        |name: &str, of: fn(&EpisodeRow) -> usize| columns::int64(name, rows.iter().map(of));
    let mut all = vec![
        number("episode_index", |row| row.number),
        columns::string_lists("tasks", &tasks),
        number("length", |row| row.frames),
        number("data/chunk_index", |row| row.place.chunk),
        number("data/file_index", |row| row.place.file),
        number("dataset_from_index", |row| row.first_frame),
        number("dataset_to_index", |row| row.first_frame + row.frames),
    ];
    let videos = rows.first().map(|row| row.videos.keys());
    for feature in videos.into_iter().flatten() {
        let part = |row: &EpisodeRow| row.videos.get(feature).copied().unwrap_or_default();
        let parts: Vec<_> = rows.iter().map(part).collect();
        let named = |name: &str| format!("videos/{feature}/{name}");
        let chunks = parts.iter().map(|part| part.place.chunk);
        let files = parts.iter().map(|part| part.place.file);
        all.push(columns::int64(&named("chunk_index"), chunks));
        all.push(columns::int64(&named("file_index"), files));
        for (name, time) in [("from_timestamp", 0), ("to_timestamp", 1)] {
            let times = parts.iter().map(|part| part.times[time]);
            all.push(columns::float64(&named(name), times));
        }
    }
    let features: Vec<_> = rows
        .first()
        .map_or(Vec::new(), |row| row.stats.keys().collect());
    for feature in features {
        all.extend(columns_of(feature, rows));
    }
    let here = |of: usize| std::iter::repeat_n(of, rows.len());
    all.push(columns::int64(
        "meta/episodes/chunk_index",
        here(place.chunk),
    ));
    all.push(columns::int64("meta/episodes/file_index", here(place.file)));
    let batch = batch(all)?;
    let mut bytes = Vec::new();
    let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties().build()))?;
    writer.write(&batch)?;
    writer.close()?;
    Ok(bytes)
}

/// The columns of a feature's statistics.
fn columns_of(feature: &str, rows: &[EpisodeRow]) -> Vec<Column> {
    let stats: Vec<_> = rows
        .iter()
        .filter_map(|row| row.stats.get(feature))
        .collect();
    let inner_lists = stats.first().map_or(0, |stats| stats.inner_lists());
    let column = |name: &str, of: &dyn Fn(&FeatureStats) -> Vec<f64>| {
        let values: Vec<_> = stats.iter().map(|stats| of(stats)).collect();
        let values: Vec<_> = values.iter().map(Vec::as_slice).collect();
        columns::tensors(&format!("stats/{feature}/{name}"), &values, inner_lists)
    };
    let mut all = vec![
        column("min", &|stats| stats.min.clone()),
        column("max", &|stats| stats.max.clone()),
        column("mean", &|stats| stats.mean.clone()),
        column("std", &|stats| stats.std.clone()),
    ];
    let counts = stats.iter().map(|stats| stats.count as i64);
    all.push(columns::lists(
        &format!("stats/{feature}/count"),
        Arc::new(Int64Array::from_iter_values(counts)),
        stats.iter().map(|_| 1),
    ));
    for (place, (name, _)) in QUANTILES.iter().enumerate() {
        all.push(column(name, &|stats| stats.quantiles[place].clone()));
    }
    all
}
