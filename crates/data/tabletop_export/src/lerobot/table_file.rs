//! Parquet files of a dataset, whoever has made them.

use std::{
    fs::File,
    io::{self, BufReader, Seek as _, SeekFrom},
    ops::Range,
    path::PathBuf,
};

use arrow_array::{RecordBatch, RecordBatchReader as _};
use parquet::{
    arrow::{
        ProjectionMask,
        arrow_reader::{ArrowReaderMetadata, ParquetRecordBatchReaderBuilder},
    },
    errors::ParquetError,
    file::metadata::RowGroupMetaData,
};
use tabletop_storage::InnerFile;

use super::{page_header::PageHeader, read_columns};
use crate::error::ExportError;

/// Most rows of a group, which is an episode: 30 days, 60 frames a second.
const MOST_ROWS: usize = 30 * 24 * 3600 * 60;

/// Number of rows that are decoded at a time, so that a row that repeats is not a million times in memory before anybody counts.
const ROWS_AT_ONCE: usize = 64;

/// Bytes that one byte of a page in the file can become: three times what Snappy makes of it.
const MOST_INFLATED: u64 = 64;

/// Bytes that a group may have when it is decoded, however few it has in the file.
const MOST_SMALL_BYTES: u64 = 1 << 28;

/// Bytes that one byte of a larger group in the file can become.
const MOST_DECODED: u64 = 8;

/// A Parquet file of a dataset. What its head says of its size is compared with what is in it, and its content is bounded.
#[derive(Debug)]
pub(super) struct TableFile {
    path: PathBuf,
    file: File,
    metadata: ArrowReaderMetadata,
}

/// True if the pages in a part of a file can have the sizes that they say.
fn pages_are_plausible(mut file: &File, range: Range<u64>) -> io::Result<bool> {
    file.seek(SeekFrom::Start(range.start))?;
    let mut file = BufReader::new(file);
    let mut at = range.start;
    while at < range.end {
        let Ok(page) = PageHeader::read(&mut file) else {
            return Ok(false);
        };
        let content = file.stream_position()?;
        let most = page.compressed.saturating_mul(MOST_INFLATED);
        if page.uncompressed > most || page.compressed > range.end.saturating_sub(content) {
            return Ok(false);
        }
        at = file.seek(SeekFrom::Start(content + page.compressed))?;
    }
    Ok(true)
}

/// What a group says of itself that cannot be, in a file of this length.
fn fault_of(group: &RowGroupMetaData, file: &File, length: u64) -> io::Result<Option<String>> {
    let rows = group.num_rows();
    if usize::try_from(rows).map_or(true, |rows| rows > MOST_ROWS) {
        let problem =
            format!("it says that a row group has {rows} rows, expected 0 to {MOST_ROWS}");
        return Ok(Some(problem));
    }
    for column in group.columns() {
        let start = column.dictionary_page_offset().filter(|start| *start > 0);
        let start = start.unwrap_or(column.data_page_offset());
        let [start, size] = [start, column.compressed_size()].map(u64::try_from);
        let range = start.ok().zip(size.ok());
        let range = range.and_then(|(start, size)| Some(start..start.checked_add(size)?));
        let range = range.filter(|range| range.end <= length);
        let is_plausible = match range {
            Some(range) => column.num_values() >= rows && pages_are_plausible(file, range)?,
            None => false,
        };
        if !is_plausible {
            let column = column.column_path();
            let problem =
                format!("the column {column} has not the size or the values that it says");
            return Ok(Some(problem));
        }
    }
    Ok(None)
}

impl TableFile {
    /// Opens a file.
    ///
    /// # Errors
    /// It cannot be read, or is none.
    pub fn open(file: &InnerFile) -> Result<Self, ExportError> {
        let path = file.path();
        let file = file.open().map_err(ExportError::io(&path))?;
        let length = file.metadata().map_err(ExportError::io(&path))?.len();
        let fault = |problem: &dyn ToString| ExportError::dataset(&path, problem.to_string());
        let metadata = ArrowReaderMetadata::load(&file, Default::default());
        let metadata = metadata.map_err(|error| fault(&error))?;
        for group in metadata.metadata().row_groups() {
            let found = fault_of(group, &file, length).map_err(ExportError::io(&path))?;
            if let Some(problem) = found {
                return Err(fault(&problem));
            }
        }
        Ok(Self {
            path,
            file,
            metadata,
        })
    }

    /// Its path.
    pub fn path(&self) -> &PathBuf {
        &self.path
    }

    /// The number of rows of each of its row groups.
    pub fn groups(&self) -> impl ExactSizeIterator<Item = usize> {
        let groups = self.metadata.metadata().row_groups().iter();
        groups.map(|group| usize::try_from(group.num_rows()).unwrap_or_default())
    }

    /// The rows of a group, as one table.
    ///
    /// # Errors
    /// They cannot be read, are more or fewer than their number, or too large.
    pub fn group(&self, group: usize) -> Result<RecordBatch, ExportError> {
        let expected = self.groups().nth(group).unwrap_or_default();
        let fault = |problem: &dyn ToString| {
            ExportError::dataset(
                &self.path,
                format!("row group {group}: {}", problem.to_string()),
            )
        };
        let file = self.file.try_clone().map_err(ExportError::io(&self.path))?;
        let reader =
            ParquetRecordBatchReaderBuilder::new_with_metadata(file, self.metadata.clone())
                .with_row_groups(vec![group])
                .with_batch_size(ROWS_AT_ONCE)
                .build()
                .map_err(|error| fault(&error))?;
        let schema = reader.schema();
        let compressed = self.metadata.metadata().row_group(group).compressed_size();
        let most = MOST_DECODED.saturating_mul(compressed.unsigned_abs());
        let most = most.max(MOST_SMALL_BYTES);
        let (mut parts, mut rows, mut bytes) = (Vec::new(), 0_usize, 0_u64);
        for part in reader {
            let part = part.map_err(|error| fault(&ParquetError::from(error)))?;
            rows += part.num_rows();
            bytes = bytes.saturating_add(part.get_array_memory_size() as u64);
            if rows > expected || bytes > most {
                let problem = format!(
                    "it has more than the {expected} rows that it says, or more than {most} bytes"
                );
                return Err(fault(&problem));
            }
            parts.push(part);
        }
        if rows != expected {
            return Err(fault(&format!("it has {rows} rows, and says {expected}")));
        }
        arrow_select::concat::concat_batches(&schema, &parts).map_err(|error| fault(&error))
    }

    /// The whole numbers in a column, group by group.
    ///
    /// # Errors
    /// There is no such column, or it cannot be read.
    pub fn whole_numbers(&self, name: &str) -> Result<Vec<Vec<i64>>, ExportError> {
        let fault = |problem: &dyn ToString| {
            ExportError::dataset(&self.path, format!("{name}: {}", problem.to_string()))
        };
        let schema = self.metadata.metadata().file_metadata().schema_descr();
        let groups = self.groups().enumerate().map(|(group, rows)| {
            let file = self.file.try_clone().map_err(ExportError::io(&self.path))?;
            let reader =
                ParquetRecordBatchReaderBuilder::new_with_metadata(file, self.metadata.clone())
                    .with_row_groups(vec![group])
                    .with_projection(ProjectionMask::columns(schema, [name]))
                    .build()
                    .map_err(|error| fault(&error))?;
            let mut numbers = Vec::new();
            for part in reader {
                let part = part.map_err(|error| fault(&ParquetError::from(error)))?;
                numbers.extend(read_columns::whole_numbers(&part, name).map_err(|it| fault(&it))?);
            }
            match numbers.len() == rows {
                true => Ok(numbers),
                false => Err(fault(&format!(
                    "{} rows, and it says {rows}",
                    numbers.len()
                ))),
            }
        });
        groups.collect()
    }

    /// All rows, group by group.
    ///
    /// # Errors
    /// As [`group`](Self::group).
    pub fn all_groups(&self) -> impl Iterator<Item = Result<RecordBatch, ExportError>> {
        (0..self.groups().len()).map(|group| self.group(group))
    }
}
