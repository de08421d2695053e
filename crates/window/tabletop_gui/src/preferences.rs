//! Preferences of a user between runs: RON files in the platform's configuration folder, one for each concern.

use std::{
    env, io,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use directories::ProjectDirs;
use ron::ser::PrettyConfig;
use serde::{Serialize, de::DeserializeOwned};
use tabletop_core::located_ron_fault;
use tabletop_storage::{Storage, Symlinks, WriterLock, parent_of, read_regular_text};
use thiserror::Error;

/// The environment variable that names another folder.
pub const FOLDER_VARIABLE: &str = "TABLETOP_CONFIG";

/// The most bytes of a file of preferences that are read.
pub(crate) const MOST_BYTES: u64 = 1 << 20;

/// The folder of the preferences.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct Preferences {
    folder: Option<PathBuf>,
}

/// The error of preferences that could not be read or kept.
#[derive(Debug, Error)]
pub enum PreferencesError {
    /// The file could not be read or written.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's message.
        error: io::Error,
    },
    /// The file is not as the program writes it.
    #[error("{path}:{}; mend or delete the file", located_ron_fault(error))]
    Syntax {
        /// The file.
        path: PathBuf,
        /// The place and the reason.
        error: Box<ron::error::SpannedError>,
    },
    /// The value has no form in RON.
    #[error("{path}: {error}")]
    Form {
        /// The file.
        path: PathBuf,
        /// The error of RON.
        error: ron::Error,
    },
}

impl Default for Preferences {
    /// The folder that `TABLETOP_CONFIG` names, or the platform's: `~/.config/tabletop` on Linux.
    fn default() -> Self {
        let named = env::var_os(FOLDER_VARIABLE).filter(|folder| !folder.is_empty());
        let folder = named.map(PathBuf::from).or_else(|| {
            let folders = ProjectDirs::from("", "", "tabletop")?;
            Some(folders.config_dir().to_owned())
        });
        Self { folder }
    }
}

impl Preferences {
    /// Preferences in a folder, which need not exist yet.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: Some(folder.into()),
        }
    }

    /// Preferences that are forgotten at once.
    pub const fn nowhere() -> Self {
        Self { folder: None }
    }

    /// The file of a concern, such as `windows`.
    pub fn file(&self, concern: &str) -> Option<PathBuf> {
        let folder = self.folder.as_ref()?;
        Some(folder.join(concern).with_extension("ron"))
    }

    /// The preferences that were kept of a concern, if any were.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or it is not of this type.
    pub fn read<T: DeserializeOwned>(&self, concern: &str) -> Result<Option<T>, PreferencesError> {
        let Some(path) = self.file(concern) else {
            return Ok(None);
        };
        match read_regular_text(&path, MOST_BYTES, Symlinks::Followed) {
            Ok(text) => ron::from_str(&text)
                .map(Some)
                .map_err(|error| PreferencesError::Syntax {
                    path,
                    error: Box::new(error),
                }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(PreferencesError::Io { path, error }),
        }
    }

    /// Keeps the value of a concern. A crash leaves the old file or the new one.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn keep<T: Serialize>(&self, concern: &str, value: &T) -> Result<(), PreferencesError> {
        let Some(path) = self.file(concern) else {
            return Ok(());
        };
        let _alone = alone(&path)?;
        write(path, value)
    }

    /// Keeps what this makes of the value of a concern, which another window may have changed meanwhile. A file that cannot be read holds none.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn change<T: Serialize + DeserializeOwned>(
        &self,
        concern: &str,
        change: impl FnOnce(Option<T>) -> T,
    ) -> Result<(), PreferencesError> {
        let Some(path) = self.file(concern) else {
            return Ok(());
        };
        let _alone = alone(&path)?;
        let kept = self.read(concern).ok().flatten();
        write(path, &change(kept))
    }
}

/// Keeps other windows from a file.
fn alone(path: &Path) -> Result<WriterLock, PreferencesError> {
    let storage = Storage::default();
    let lock = || {
        storage.create_folders(parent_of(path))?;
        WriterLock::of_place(path, &storage)
    };
    lock().map_err(|error| PreferencesError::Io {
        path: path.to_owned(),
        error,
    })
}

fn write<T: Serialize>(path: PathBuf, value: &T) -> Result<(), PreferencesError> {
    match ron::ser::to_string_pretty(value, PrettyConfig::default()) {
        Ok(text) => replace(&path, &text).map_err(|error| PreferencesError::Io { path, error }),
        Err(error) => Err(PreferencesError::Form { path, error }),
    }
}

/// Writes all of a file, or leaves the old one.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<()> {
    let storage = Storage::default();
    if let Some(folder) = path.parent() {
        storage.create_folders(folder)?;
    }
    storage.replace(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use serde::Deserialize;

    #[derive(Serialize, Deserialize, Debug, PartialEq)]
    struct Size {
        width: u32,
    }

    fn folder(name: &str) -> PathBuf {
        env::temp_dir().join(format!(
            "tabletop-preferences-{name}-{}",
            std::process::id()
        ))
    }

    #[test]
    fn kept_preferences_read_back() {
        let folder = folder("kept");
        let preferences = Preferences::in_folder(&folder);
        assert_eq!(preferences.read::<Size>("display").unwrap(), None);
        for width in [1, 2] {
            preferences.keep("display", &Size { width }).unwrap();
            let read = preferences.read("display").unwrap();
            assert_eq!(read, Some(Size { width }));
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_damaged_file_is_named_with_the_place() {
        let folder = folder("damaged");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("display.ron"), "(width: two)").unwrap();
        let preferences = Preferences::in_folder(&folder);
        let error = preferences.read::<Size>("display").unwrap_err();
        let text = error.to_string();
        assert!(text.contains("display.ron:1:"), "{text}");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn nowhere_keeps_nothing() {
        let preferences = Preferences::nowhere();
        preferences.keep("display", &Size { width: 1 }).unwrap();
        assert_eq!(preferences.read::<Size>("display").unwrap(), None);
    }
}
