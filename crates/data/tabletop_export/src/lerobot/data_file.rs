//! `data/chunk-XXX/file-XXX.parquet`: a row a frame, a row group an episode.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::Arc,
};

use arrow_array::{Float32Array, Int32Array};
use parquet::{arrow::ArrowWriter, errors::ParquetError};
use tabletop_storage::StoredFile;
use tabletop_training::TrainingEpisode;

use super::{
    columns::{self, Column},
    episode_table::EpisodeRow,
    info::{feature_of_camera, feature_of_depth, feature_of_ids, signals_of},
    language,
    place::{DataPlace, MOST_FILE_BYTES},
    table::{batch, properties, schema_of},
};
use crate::error::ExportError;

/// A file that gets episodes.
#[derive(Debug)]
pub(super) struct DataFile {
    path: PathBuf,
    place: DataPlace,
    writer: ArrowWriter<ParquetFile>,
    has_language: bool,
}

/// A file that is written by others' code.
#[derive(Debug)]
struct ParquetFile(StoredFile);

impl Write for ParquetFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.append(bytes).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl DataFile {
    /// A file for episodes like this one.
    pub fn new(
        path: PathBuf,
        file: StoredFile,
        place: DataPlace,
        episode: &TrainingEpisode,
        has_language: bool,
    ) -> Result<Self, ExportError> {
        let columns = columns_of(episode, &EpisodeRow::default(), has_language);
        let schema = schema_of(&columns);
        let properties = properties()
            // Never by itself: readers rely on one group an episode.
            .set_max_row_group_row_count(Some(usize::MAX))
            .build();
        let writer = ArrowWriter::try_new(ParquetFile(file), schema, Some(properties));
        let writer = writer.map_err(|error| failed(&path, error))?;
        Ok(Self {
            path,
            place,
            writer,
            has_language,
        })
    }

    pub const fn place(&self) -> DataPlace {
        self.place
    }

    /// True if the next episode belongs to another file.
    pub fn is_full(&self) -> bool {
        self.writer.bytes_written() >= MOST_FILE_BYTES
    }

    /// Writes an episode.
    pub fn write(
        &mut self,
        episode: &TrainingEpisode,
        row: &EpisodeRow,
    ) -> Result<(), ExportError> {
        let batch = batch(columns_of(episode, row, self.has_language))
            .map_err(|error| ExportError::dataset(&self.path, error))?;
        let written = self.writer.write(&batch).and_then(|()| self.writer.flush());
        written.map_err(|error| failed(&self.path, error))
    }

    /// Makes it whole, on the disk.
    pub fn close(self) -> Result<(), ExportError> {
        let file = self.writer.into_inner();
        let file = file.map_err(|error| failed(&self.path, error))?;
        file.0.sync().map_err(ExportError::io(&self.path))
    }
}

fn failed(path: &Path, error: ParquetError) -> ExportError {
    let ParquetError::External(error) = error else {
        return ExportError::dataset(path, error);
    };
    match error.downcast::<io::Error>() {
        Ok(error) => ExportError::io(path)(*error),
        Err(error) => ExportError::dataset(path, error),
    }
}

/// The columns of an episode's frames.
fn columns_of(episode: &TrainingEpisode, row: &EpisodeRow, has_language: bool) -> Vec<Column> {
    let frames = episode.len();
    let signals = signals_of(episode)
        .map(|(name, signal)| columns::vectors(name, signal.names.len(), &signal.values));
    let mut columns: Vec<_> = signals.collect();
    for camera in episode
        .cameras
        .iter()
        .filter(|camera| camera.video.is_none())
    {
        columns.push(columns::files(
            &feature_of_camera(&camera.name),
            camera.images.iter().map(|image| image.png.as_slice()),
            (0..frames).map(|frame| format!("frame-{frame:06}.png")),
        ));
    }
    for camera in &episode.cameras {
        let size = camera.size().map(|side| side as usize);
        if !camera.depths.is_empty() {
            let values = camera
                .depths
                .iter()
                .flat_map(|depths| depths.iter().copied());
            let values = Float32Array::from_iter_values(values);
            let name = feature_of_depth(&camera.name);
            columns.push(columns::pictures(&name, size, Arc::new(values)));
        }
        if !camera.ids.is_empty() {
            let values = camera.ids.iter().flat_map(|ids| ids.iter().copied());
            let values = Int32Array::from_iter_values(values.map(i32::from));
            let name = feature_of_ids(&camera.name);
            columns.push(columns::pictures(&name, size, Arc::new(values)));
        }
    }
    if has_language {
        columns.push(language::persistent(episode));
        columns.push(language::events(episode));
    }
    let seconds = (0..frames).map(|frame| frame as f32 / episode.fps as f32);
    columns.push(columns::float32("timestamp", seconds));
    columns.push(columns::int64("frame_index", 0..frames));
    columns.push(columns::int64(
        "episode_index",
        std::iter::repeat_n(row.number, frames),
    ));
    columns.push(columns::int64(
        "index",
        row.first_frame..row.first_frame + frames,
    ));
    columns.push(columns::int64(
        "task_index",
        std::iter::repeat_n(row.task_number, frames),
    ));
    columns
}
