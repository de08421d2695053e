//! The folder in memory through which the program and an engine exchange files.

use std::{
    collections::hash_map::RandomState,
    env, fs,
    hash::{BuildHasher, Hasher},
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use crate::{
    error::EngineError,
    protocol::{Arrays, MAX_FILE_BYTES, ProtocolError},
};

/// A private folder that is removed in the end.
#[derive(Debug)]
pub(crate) struct Session {
    folder: PathBuf,
}

impl Session {
    /// Makes the folder, with the driver's files in "driver".
    pub(crate) fn new(driver: &[(String, String)]) -> Result<Self, EngineError> {
        let mut result = Err(io::Error::from(io::ErrorKind::NotFound));
        let mut tried = env::temp_dir();
        for base in bases() {
            tried = base.join(format!(
                "tabletop-{:016x}",
                RandomState::new().build_hasher().finish()
            ));
            result = make_private(&tried);
            if result.is_ok() {
                break;
            }
        }
        result.map_err(|error| EngineError::file(&tried, &error))?;
        let session = Self { folder: tried };
        for (name, text) in driver {
            let path = session.driver().join(name);
            let parent = path.parent().unwrap_or(&session.folder);
            fs::create_dir_all(parent)
                .and_then(|()| fs::write(&path, text))
                .map_err(|error| EngineError::file(&path, &error))?;
        }
        Ok(session)
    }

    /// The folder itself.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where the driver's files are.
    pub(crate) fn driver(&self) -> PathBuf {
        self.folder.join("driver")
    }

    /// Writes a request, for the engine to read when it is told to.
    pub(crate) fn write_request(&self, arrays: &Arrays) -> Result<(), EngineError> {
        let path = self.folder.join("request.bin");
        let bytes = arrays.encode()?;
        // Written over: to give the memory back and take it anew costs more than all the rest.
        let mut options = fs::OpenOptions::new();
        let file = options.write(true).create(true).truncate(false).open(&path);
        file.and_then(|mut file| {
            file.write_all(&bytes)?;
            file.set_len(bytes.len() as u64)
        })
        .map_err(|error| EngineError::file(path, &error))
    }

    /// Reads what the engine answered.
    pub(crate) fn read_reply(&self) -> Result<Arrays, EngineError> {
        let path = self.folder.join("reply.bin");
        let size = fs::metadata(&path)
            .map_err(|error| EngineError::file(&path, &error))?
            .len();
        if size > MAX_FILE_BYTES as u64 {
            return Err(ProtocolError::Damaged("it is too long").into());
        }
        let bytes = fs::read(&path).map_err(|error| EngineError::file(&path, &error))?;
        Ok(Arrays::decode(&bytes)?)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Nothing can be done about a folder that stays; it is in memory or among temporary files.
        drop(fs::remove_dir_all(&self.folder));
    }
}

/// Where folders may be made: in memory first.
fn bases() -> impl Iterator<Item = PathBuf> {
    let runtime = env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    let memory = cfg!(unix).then(|| PathBuf::from("/dev/shm"));
    let usable = |base: &PathBuf| base.is_absolute() && base.is_dir();
    [runtime, memory]
        .into_iter()
        .flatten()
        .filter(usable)
        .chain([env::temp_dir()])
}

#[cfg(unix)]
fn make_private(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::DirBuilderExt as _;
    fs::DirBuilder::new().mode(0o700).create(folder)
}

#[cfg(not(unix))]
fn make_private(folder: &Path) -> io::Result<()> {
    fs::create_dir(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_is_private_and_goes() {
        let session = Session::new(&[("sub/a.m".into(), "x = 1;".into())]).unwrap();
        let folder = session.folder().to_owned();
        assert_eq!(
            fs::read_to_string(folder.join("driver/sub/a.m")).unwrap(),
            "x = 1;"
        );
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            assert_eq!(
                fs::metadata(&folder).unwrap().permissions().mode() & 0o777,
                0o700
            );
        }
        drop(session);
        assert!(!folder.exists());
    }
}
