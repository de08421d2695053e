//! `meta/episodes/chunk-XXX/file-XXX.parquet`: a row an episode.

use std::{collections::BTreeMap, path::Path, sync::Arc};

use arrow_array::{
    Int64Array, RecordBatch,
    types::{ArrowPrimitiveType, Float64Type, Int64Type},
};
use arrow_schema::ArrowError;
use parquet::arrow::ArrowWriter;
use tabletop_storage::InnerFile;
use tabletop_training::{FeatureStats, QUANTILES};

use super::{
    columns::{self, Column},
    info::Info,
    place::{DataPlace, FileSeries},
    read_columns::rows_of,
    table::{batch, properties},
    table_file::TableFile,
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
        .map_err(|error| ExportError::dataset(place.path(&FileSeries::episodes()).as_path(), error))
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

/// The videos of each episode with the statistics of their colours, by the episode's number and the feature.
pub(super) fn read_videos(
    folder: &Path,
    features: &[String],
) -> Result<BTreeMap<usize, ShownVideos>, ExportError> {
    let mut all = BTreeMap::new();
    visit_rows(folder, |row| {
        let (number, videos) = row.videos(features)?;
        match all.insert(number, videos) {
            Some(_) => Err(format!("it has episode {number} again")),
            None => Ok(()),
        }
    })?;
    Ok(all)
}

/// The statistics of all episodes together, of the features whose statistics the tables have.
pub(super) fn read_stats(
    folder: &Path,
    info: &Info,
) -> Result<BTreeMap<String, FeatureStats>, ExportError> {
    let mut all: BTreeMap<String, FeatureStats> = BTreeMap::new();
    visit_rows(folder, |row| {
        // A table of an export that was taken back may have stayed.
        if row.count("episode_index")? >= info.total_episodes {
            return Ok(());
        }
        for (feature, described) in info.features() {
            if row
                .batch
                .column_by_name(&format!("stats/{feature}/mean"))
                .is_none()
            {
                continue;
            }
            let is_of_pictures = matches!(described["dtype"].as_str(), Some("image" | "video"));
            let stats = row.stats(feature, is_of_pictures)?;
            match all.get_mut(feature) {
                Some(all) => all.merge(&stats),
                None => drop(all.insert(feature.clone(), stats)),
            }
        }
        Ok(())
    })?;
    Ok(all)
}

/// Visits the rows of all episodes.
fn visit_rows(
    folder: &Path,
    mut visit: impl FnMut(TableRow<'_>) -> Result<(), String>,
) -> Result<(), ExportError> {
    let series = FileSeries::episodes();
    for place in series.places(folder)? {
        let file = InnerFile::new(folder, place.path(&series));
        let table = TableFile::open(&file)?;
        for batch in table.all_groups() {
            let batch = batch?;
            for row in 0..batch.num_rows() {
                let row = TableRow { batch: &batch, row };
                visit(row).map_err(|problem| ExportError::dataset(table.path(), problem))?;
            }
        }
    }
    Ok(())
}

/// The number of the first episode in a table of episodes or frames, if it can be read.
pub(super) fn first_episode(file: &InnerFile) -> Option<usize> {
    let table = TableFile::open(file).ok()?;
    let is_empty = |batch: &RecordBatch| batch.num_rows() == 0;
    let mut groups = table.all_groups();
    let first = groups.find(|batch| !batch.as_ref().is_ok_and(is_empty));
    let batch = first?.ok()?;
    let first = TableRow {
        batch: &batch,
        row: 0,
    };
    first.count("episode_index").ok()
}

/// The videos that show an episode, by their features.
pub(super) type ShownVideos = BTreeMap<String, (VideoPart, FeatureStats)>;

/// A row of a table that is read.
struct TableRow<'b> {
    batch: &'b RecordBatch,
    row: usize,
}

impl TableRow<'_> {
    fn videos(&self, features: &[String]) -> Result<(usize, ShownVideos), String> {
        let videos = features.iter().map(|feature| {
            let place = DataPlace {
                chunk: self.count(&format!("videos/{feature}/chunk_index"))?,
                file: self.count(&format!("videos/{feature}/file_index"))?,
            };
            let time = |name: &str| {
                let name = format!("videos/{feature}/{name}");
                self.one::<Float64Type>(&name)
            };
            let times = [time("from_timestamp")?, time("to_timestamp")?];
            Ok((
                feature.clone(),
                (VideoPart { place, times }, self.stats(feature, true)?),
            ))
        });
        let videos = videos.collect::<Result<_, String>>()?;
        Ok((self.count("episode_index")?, videos))
    }

    /// The statistics of a feature, of pictures those of their colours.
    fn stats(&self, feature: &str, is_of_pictures: bool) -> Result<FeatureStats, String> {
        let column = |name: &str| format!("stats/{feature}/{name}");
        let numbers = |name: &str| self.numbers::<Float64Type>(&column(name));
        let [q01, q10, q50, q90, q99] = QUANTILES.map(|(name, _)| numbers(name));
        let all = FeatureStats {
            min: numbers("min")?,
            max: numbers("max")?,
            mean: numbers("mean")?,
            std: numbers("std")?,
            count: self.count(&column("count"))? as u64,
            quantiles: [q01?, q10?, q50?, q90?, q99?],
            is_of_pictures,
        };
        match all.components() {
            Some(3) => Ok(all),
            Some(_) if !is_of_pictures => Ok(all),
            None => Err(format!("the statistics of {feature} are incomplete")),
            Some(_) => Err(format!(
                "the statistics of {feature} are not those of three colours"
            )),
        }
    }

    /// The numbers of a column.
    fn numbers<N: ArrowPrimitiveType>(&self, name: &str) -> Result<Vec<N::Native>, String> {
        let row = self.batch.slice(self.row, 1);
        let numbers = rows_of::<N>(&row, name)?.into_iter().next();
        numbers.ok_or_else(|| format!("there is no column {name}"))
    }

    /// The only number of a column.
    fn one<N: ArrowPrimitiveType>(&self, name: &str) -> Result<N::Native, String> {
        match self.numbers::<N>(name)?.as_slice() {
            [number] => Ok(*number),
            numbers => Err(format!("{name} has {} numbers, expected 1", numbers.len())),
        }
    }

    /// The only number of a column, from 0 on.
    fn count(&self, name: &str) -> Result<usize, String> {
        let number = self.one::<Int64Type>(name)?;
        usize::try_from(number).map_err(|_| format!("{name} is {number}, expected 0 or more"))
    }
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
