//! The places of files in a dataset.

use std::path::{Path, PathBuf};

/// Size from which on a file gets no more episodes, in bytes.
pub(super) const MOST_FILE_BYTES: usize = 100_000_000;

/// Size from which on a video gets no more episodes, in bytes.
pub(super) const MOST_VIDEO_BYTES: u64 = 200_000_000;

/// Number of files in a folder.
pub(super) const FILES_PER_CHUNK: usize = 1000;

/// The place of a file among those of its kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
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

    /// Its path in the dataset, of a kind such as `data` and with this extension.
    pub fn path(self, kind: &str, extension: &str) -> PathBuf {
        let Self { chunk, file } = self;
        format!("{kind}/chunk-{chunk:03}/file-{file:03}.{extension}").into()
    }
}

/// Number of files of a kind that a dataset has.
pub(super) fn count(folder: &Path, kind: &str, extension: &str) -> usize {
    let path = |number| folder.join(DataPlace::of(number).path(kind, extension));
    (0..).take_while(|number| path(*number).exists()).count()
}
