//! The files of episodes, counted.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::Path,
};

use tabletop_storage::{InnerFile, InnerPath, StrayPath};

use super::example::masked;
use crate::error::ExportError;

/// Bytes of a record before its content: the length, and the checksum of the length.
const HEAD: u64 = 12;

/// Bytes after the content: its checksum.
const TAIL: u64 = 4;

/// What is in the files of a split.
#[derive(Debug, Default)]
pub(super) struct Shards {
    /// Number of episodes in each.
    pub episodes: Vec<u64>,
    /// Bytes of all of them.
    pub bytes: u64,
}

impl Shards {
    /// Counts the episodes in the first files of a dataset of this name.
    ///
    /// # Errors
    /// One is not there, cannot be read, or is damaged.
    pub fn count(folder: &Path, name: &str, files: usize) -> Result<Self, ExportError> {
        let mut all = Self::default();
        for number in 0..files {
            let file = shard_path(name, number);
            let file = file.map_err(|error| ExportError::dataset(folder, error))?;
            let file = InnerFile::new(folder, file);
            let path = file.path();
            let counted = file.open().and_then(records_in);
            let (records, bytes) = counted.map_err(ExportError::io(&path))?;
            let records = records
                .ok_or_else(|| ExportError::dataset(&path, "it is no whole file of records"))?;
            all.episodes.push(records);
            all.bytes += bytes;
        }
        Ok(all)
    }
}

/// The path of the file of this number of a dataset.
///
/// # Errors
/// The dataset's name can be no part of it.
pub(super) fn shard_path(name: &str, number: usize) -> Result<InnerPath, StrayPath> {
    InnerPath::name(format!("{name}-train.tfrecord-{number:05}"))
}

/// Number of the records in a file, if their lengths lead to its end, and of its bytes.
fn records_in(mut file: File) -> io::Result<(Option<u64>, u64)> {
    let length = file.metadata()?.len();
    let (mut records, mut at) = (0, 0);
    while at < length {
        let Some(end) = record_at(&mut file, at, length)? else {
            return Ok((None, length));
        };
        at = end;
        records += 1;
    }
    Ok((Some(records), length))
}

/// The end of the record that begins at a place, if it is in the file.
fn record_at(file: &mut File, at: u64, length: u64) -> io::Result<Option<u64>> {
    if length - at < HEAD + TAIL {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(at))?;
    let mut content = [0; 8];
    file.read_exact(&mut content)?;
    if read_checksum(file)? != masked(crc32c::crc32c(&content)) {
        return Ok(None);
    }
    let size = u64::from_le_bytes(content);
    if size > length - at - HEAD - TAIL {
        return Ok(None);
    }
    Ok(Some(at + HEAD + size + TAIL))
}

fn read_checksum(file: &mut File) -> io::Result<u32> {
    let mut bytes = [0; 4];
    file.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}
