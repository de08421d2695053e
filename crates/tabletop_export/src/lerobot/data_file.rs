//! `data/chunk-XXX/file-XXX.parquet`: a row a frame, a row group an episode.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::Arc,
};

use arrow::{
    array::RecordBatch,
    datatypes::{Field, Schema},
    error::ArrowError,
};
use parquet::{
    arrow::ArrowWriter,
    basic::Compression,
    errors::ParquetError,
    file::properties::{WriterProperties, WriterPropertiesBuilder},
};
use tabletop_storage::StoredFile;

use super::{
    columns::{self, Column},
    episode_table::EpisodeRow,
    info::feature_of_camera,
    language,
};
use crate::{episode::Episode, error::ExportError};

/// Size from which on a file gets no more episodes, in bytes.
pub(super) const MOST_FILE_BYTES: usize = 100_000_000;

/// Number of files in a folder.
pub(super) const FILES_PER_CHUNK: usize = 1000;

/// The place of a file among those of its kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DataPlace {
    pub chunk: usize,
    pub file: usize,
}

impl DataPlace {
    /// That of the file with this number.
    pub const fn of(number: usize) -> Self {
        Self {
            chunk: number / FILES_PER_CHUNK,
            file: number % FILES_PER_CHUNK,
        }
    }

    /// Its path in the dataset.
    pub fn path(self, kind: &str) -> PathBuf {
        let Self { chunk, file } = self;
        format!("{kind}/chunk-{chunk:03}/file-{file:03}.parquet").into()
    }
}

/// Number of files that a dataset has.
pub(super) fn count(folder: &Path) -> usize {
    let is_there = |number: &usize| folder.join(DataPlace::of(*number).path("data")).exists();
    (0..).take_while(is_there).count()
}

/// A file that gets episodes.
#[derive(Debug)]
pub(super) struct DataFile {
    path: PathBuf,
    place: DataPlace,
    writer: ArrowWriter<CountingFile>,
}

/// A file that is written by others' code.
#[derive(Debug)]
struct CountingFile(StoredFile);

impl Write for CountingFile {
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
        episode: &Episode,
    ) -> Result<Self, ExportError> {
        let columns = columns_of(episode, &EpisodeRow::default());
        let schema = schema_of(&columns);
        let properties = properties()
            // Never by itself: readers rely on one group an episode.
            .set_max_row_group_row_count(Some(usize::MAX))
            .build();
        let writer = ArrowWriter::try_new(CountingFile(file), schema, Some(properties));
        let writer = writer.map_err(|error| failed(&path, error))?;
        Ok(Self {
            path,
            place,
            writer,
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
    pub fn write(&mut self, episode: &Episode, row: &EpisodeRow) -> Result<(), ExportError> {
        let batch = batch(columns_of(episode, row))
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

/// The usual properties of files.
pub(super) fn properties() -> WriterPropertiesBuilder {
    WriterProperties::builder().set_compression(Compression::SNAPPY)
}

/// A table of these columns.
pub(super) fn batch(columns: Vec<Column>) -> Result<RecordBatch, ArrowError> {
    let schema = schema_of(&columns);
    RecordBatch::try_new(
        schema,
        columns.into_iter().map(|(_, array)| array).collect(),
    )
}

fn schema_of(columns: &[Column]) -> Arc<Schema> {
    let fields: Vec<Field> = columns.iter().map(|(field, _)| field.clone()).collect();
    Arc::new(Schema::new(fields))
}

fn failed(path: &Path, error: ParquetError) -> ExportError {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => ExportError::io(path)(*error),
            Err(error) => ExportError::dataset(path, error),
        },
        error => ExportError::dataset(path, error),
    }
}

/// The columns of an episode's frames.
fn columns_of(episode: &Episode, row: &EpisodeRow) -> Vec<Column> {
    let frames = episode.len();
    let mut columns = vec![
        columns::vectors(
            "observation.state",
            episode.state.names.len(),
            &episode.state.values,
        ),
        columns::vectors("action", episode.action.names.len(), &episode.action.values),
    ];
    for camera in &episode.cameras {
        columns.push(columns::files(
            &feature_of_camera(&camera.name),
            camera.images.iter().map(|image| image.png.as_slice()),
            (0..frames).map(|frame| format!("frame-{frame:06}.png")),
        ));
    }
    columns.push(language::persistent(episode));
    columns.push(language::events(episode));
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
