//! Temporary folders: they are removed with the program that made them, or by the next one if it was killed.

use std::{
    env, io,
    path::{Path, PathBuf},
};

use crate::{locked_folder::LockedFolder, storage::Storage};

/// A folder among the system's temporary files that is removed when it is dropped.
#[derive(Debug)]
pub struct TemporaryFolder {
    path: PathBuf,
    folder: Option<LockedFolder>,
}

impl TemporaryFolder {
    /// Makes a new folder of this kind: `KIND-NUMBER`. Those of the same kind that killed programs have left are removed.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn new(kind: &str) -> io::Result<Self> {
        let prefix = format!("{kind}-");
        let folder = LockedFolder::create(&env::temp_dir(), &prefix, &Storage::default())?;
        Ok(Self {
            path: folder.path().to_owned(),
            folder: Some(folder),
        })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // A folder that stays is removed by the next program.
        let _removed = self.folder.take().map(LockedFolder::remove);
    }
}
