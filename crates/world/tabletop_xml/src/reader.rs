//! Task files on the disk and inside of the program.

use std::{
    io,
    path::{Path, PathBuf},
};

use tabletop_core::ShippedFiles;

use crate::{
    ExpandedTask, MAX_FILE_BYTES, ParsedTask,
    files::{Arena, FileTree, TaskPath, read_file},
    parse::TaskReading,
};

/// A reader of task files on disk and inside the program.
///
/// A task file can include others in its folder and below, and in folders that the user allows; nothing else is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct TaskReader<'s> {
    shipped: Option<&'s ShippedFiles>,
    allowed: &'s [PathBuf],
}

impl<'s> TaskReader<'s> {
    /// Reads files inside the program where there is nothing on disk.
    pub const fn with_shipped(shipped: &'s ShippedFiles) -> Self {
        Self {
            shipped: Some(shipped),
            allowed: &[],
        }
    }

    /// Lets task files include files in these folders and below, too.
    #[must_use]
    pub const fn allowing(self, folders: &'s [PathBuf]) -> Self {
        Self {
            allowed: folders,
            ..self
        }
    }

    /// Reads a task file.
    ///
    /// # Errors
    ///
    /// There is no such file, it is not a file, it cannot be read, or it is larger than [`MAX_FILE_BYTES`].
    pub fn read(&self, path: &Path) -> Result<ParsedTask, ReadError> {
        let file = self.open(path)?;
        Ok(TaskReading::read(&file.tree, &file.path, file.bytes, &Arena::default()).parsed())
    }

    /// Reads and expands a task file.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read).
    pub fn expand(&self, path: &Path) -> Result<ExpandedTask, ReadError> {
        let file = self.open(path)?;
        Ok(TaskReading::read(&file.tree, &file.path, file.bytes, &Arena::default()).expanded())
    }

    fn open(&self, path: &Path) -> Result<OpenFile<'s>, ReadError> {
        if let Some((files, file)) = self
            .shipped
            .and_then(|files| Some((files, files.find(path)?)))
        {
            let tree = FileTree::Shipped(files);
            return Ok(OpenFile {
                path: tree.task(&file.name()),
                bytes: file.text.as_bytes().to_vec(),
                tree,
            });
        }
        let bytes = self.bytes_of(path)?;
        let tree = FileTree::on_disk(path, self.allowed).unwrap_or(FileTree::Absent);
        Ok(OpenFile {
            path: tree.task(path),
            bytes,
            tree,
        })
    }

    fn bytes_of(&self, path: &Path) -> Result<Vec<u8>, ReadError> {
        let failed = |source| ReadError::Io {
            path: path.to_path_buf(),
            source,
            way_on: self
                .shipped
                .map_or_else(String::new, |files| files.way_on(path, &["tablesetup"])),
        };
        if !path.metadata().map_err(failed)?.is_file() {
            return Err(ReadError::NotAFile {
                path: path.to_path_buf(),
            });
        }
        let bytes = read_file(path, MAX_FILE_BYTES).map_err(failed)?;
        match bytes.len() > MAX_FILE_BYTES {
            true => Err(ReadError::TooLarge {
                path: path.to_path_buf(),
            }),
            false => Ok(bytes),
        }
    }
}

/// A task file and its surroundings.
struct OpenFile<'s> {
    tree: FileTree<'s>,
    path: TaskPath,
    bytes: Vec<u8>,
}

/// The error of a task file that cannot be read at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system does not give it, for example because it does not exist.
    #[error("{path}: it cannot be read: {source}, expected a task file{way_on}", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
        /// The shipped file that may be meant.
        way_on: String,
    },
    /// It is a folder, a device or a pipe.
    #[error("{path}: it is not a file, expected a task file", path = path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// It has more than [`MAX_FILE_BYTES`].
    #[error("{path}: it is too large, expected at most {MAX_FILE_BYTES} bytes", path = path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
}

/// Reads a task file from the disk.
///
/// # Errors
///
/// There is no such file, it is not a file, it cannot be read, or it is larger than [`MAX_FILE_BYTES`].
pub fn read_task(path: &Path) -> Result<ParsedTask, ReadError> {
    TaskReader::default().read(path)
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};

    use super::*;

    #[test]
    fn a_file_that_cannot_be_read_is_one_clear_error() {
        let folder = std::env::temp_dir().join(format!("tabletop_xml_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let message = |path: &Path| read_task(path).unwrap_err().to_string();

        let missing = folder.join("missing.xml");
        assert!(
            message(&missing).starts_with(&format!("{}: it cannot be read: ", missing.display()))
        );
        assert!(message(&folder).contains("it is not a file"));
        let large = folder.join("large.xml");
        File::create(&large).unwrap().set_len(20 << 20).unwrap();
        assert!(message(&large).ends_with("it is too large, expected at most 16777216 bytes"));

        fs::remove_dir_all(&folder).unwrap();
    }
}
