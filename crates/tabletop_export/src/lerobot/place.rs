//! The places of files in a dataset.

use std::path::{Path, PathBuf};

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
