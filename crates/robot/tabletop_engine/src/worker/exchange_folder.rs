//! The folder through which the program and an engine exchange files.

use std::{
    fs::OpenOptions,
    io::Write as _,
    path::{Path, PathBuf},
};

use crate::{
    error::EngineError,
    private_folder::PrivateFolder,
    protocol::{Arrays, MAX_FILE_BYTES},
    regular_file::{self, Links},
};

/// A place with less room than this, in bytes, is full.
const LEAST_ROOM: usize = 1 << 20;

/// A private folder with an engine's driver in it.
#[derive(Debug)]
pub(crate) struct ExchangeFolder {
    folder: PrivateFolder,
}

impl ExchangeFolder {
    /// Makes the folder, with the driver's files in "driver".
    pub(crate) fn new(driver: &[(String, String)]) -> Result<Self, EngineError> {
        let folder = PrivateFolder::filled(|folder| {
            for (name, text) in driver {
                folder.write(&format!("driver/{name}"), text.as_bytes())?;
            }
            // The least room that a call needs.
            folder.write("request.bin", &[0; LEAST_ROOM])
        })?;
        Ok(Self { folder })
    }

    /// The folder itself.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The folder of the driver's files.
    pub(crate) fn driver(&self) -> PathBuf {
        self.folder().join("driver")
    }

    /// Writes a request, which the engine reads on its trigger.
    pub(crate) fn write_request(&self, arrays: &Arrays) -> Result<(), EngineError> {
        let path = self.folder().join("request.bin");
        let bytes = arrays.encode()?;
        // Written over: to give the memory back and take it anew costs more than all the rest.
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(false);
        let file = regular_file::open(&path, &mut options, Links::Refused);
        file.and_then(|mut file| {
            file.write_all(&bytes)?;
            file.set_len(bytes.len() as u64)
        })
        .map_err(|error| EngineError::file(path, &error))
    }

    /// Reads the engine's reply.
    pub(crate) fn read_reply(&self) -> Result<Arrays, EngineError> {
        let path = self.folder().join("reply.bin");
        let bytes = regular_file::read(&path, MAX_FILE_BYTES, Links::Refused)
            .map_err(|error| EngineError::file(&path, &error))?;
        Ok(Arrays::decode(&bytes)?)
    }
}
