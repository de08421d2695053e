//! The places of files in a dataset.

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
};

use tabletop_storage::{InnerPath, Storage, StrayPath};

use crate::error::ExportError;

/// Size from which on a file gets no more episodes, in bytes.
pub(super) const MOST_FILE_BYTES: usize = 100_000_000;

/// Size from which on a video gets no more episodes, in bytes.
pub(super) const MOST_VIDEO_BYTES: u64 = 200_000_000;

/// Number of files in a folder.
pub(super) const FILES_PER_CHUNK: usize = 1000;

/// Files of a kind that are numbered, in folders of their own.
#[derive(Clone, Debug)]
pub(super) struct FileSeries {
    folder: InnerPath,
    extension: &'static str,
}

impl FileSeries {
    /// The tables of frames.
    pub fn frames() -> Self {
        Self::tables("data")
    }

    /// The tables of episodes.
    pub fn episodes() -> Self {
        Self::tables("meta/episodes")
    }

    fn tables(folder: &'static str) -> Self {
        Self {
            folder: InnerPath::fixed(folder),
            extension: ".parquet",
        }
    }

    /// The videos of a feature, which has a folder of its name.
    ///
    /// # Errors
    /// No folder can have its name.
    pub fn videos(feature: &str) -> Result<Self, StrayPath> {
        Ok(Self {
            folder: InnerPath::fixed("videos").then(&InnerPath::name(feature)?),
            extension: ".mp4",
        })
    }

    /// The places of the files that a dataset has, in order. Numbers may be missing: who deletes episodes leaves the other files where they are.
    ///
    /// # Errors
    /// A folder cannot be read.
    pub fn places(&self, folder: &Path) -> Result<Vec<DataPlace>, ExportError> {
        let kind = self.folder.below(folder);
        let mut places = Vec::new();
        for (chunk, folder) in numbered_in(&kind, "chunk-", "")? {
            let files = numbered_in(&folder, "file-", self.extension)?;
            places.extend(files.into_iter().map(|(file, _)| DataPlace { chunk, file }));
        }
        places.sort();
        Ok(places)
    }
}

/// The entries of a folder that have such a name with a number, which is written as this program writes it.
fn numbered_in(
    folder: &Path,
    before: &'static str,
    after: &'static str,
) -> Result<Vec<(usize, PathBuf)>, ExportError> {
    let entries = match Storage::default().entries(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(ExportError::io(folder)(error)),
    };
    let numbered = entries.into_iter().filter_map(|path| {
        let name = path.file_name()?.to_str()?;
        let number = name.strip_prefix(before)?.strip_suffix(after)?;
        let number: u32 = number.parse().ok()?;
        let expected = InnerPath::padded(before, 3, number, after);
        (expected.as_path() == Path::new(name)).then_some((number as usize, path))
    });
    Ok(numbered.collect())
}

/// The place of a file among those of its kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct DataPlace {
    pub chunk: usize,
    pub file: usize,
}

impl DataPlace {
    /// The first place after these.
    pub fn after(taken: impl IntoIterator<Item = Self>) -> Self {
        let last = taken.into_iter().max();
        last.map_or(Self::default(), |Self { chunk, file }| {
            match file + 1 < FILES_PER_CHUNK {
                true => Self {
                    chunk,
                    file: file + 1,
                },
                false => Self {
                    chunk: chunk + 1,
                    file: 0,
                },
            }
        })
    }

    /// The path in the dataset of the file of a kind.
    pub fn path(self, kind: &FileSeries) -> InnerPath {
        let Self { chunk, file } = self;
        let chunk = InnerPath::padded("chunk-", 3, chunk as u64, "");
        let file = InnerPath::padded("file-", 3, file as u64, kind.extension);
        kind.folder.then(&chunk).then(&file)
    }
}
