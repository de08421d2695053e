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

/// A place with less room than this, in bytes, is full.
const LEAST_ROOM: usize = 1 << 20;

/// A private folder that is removed in the end.
#[derive(Debug)]
pub(crate) struct Session {
    folder: PathBuf,
}

impl Session {
    /// Makes the folder, with the driver's files in "driver".
    pub(crate) fn new(driver: &[(String, String)]) -> Result<Self, EngineError> {
        Self::in_one_of(bases(), driver)
    }

    /// Makes it in the first place that lets it and has the room.
    fn in_one_of(
        bases: impl Iterator<Item = PathBuf>,
        driver: &[(String, String)],
    ) -> Result<Self, EngineError> {
        let mut result = Err(EngineError::file(
            env::temp_dir(),
            &io::ErrorKind::NotFound.into(),
        ));
        for base in bases {
            result = Self::in_place(&base, driver);
            if result.is_ok() {
                break;
            }
        }
        result
    }

    fn in_place(base: &Path, driver: &[(String, String)]) -> Result<Self, EngineError> {
        let number = RandomState::new().build_hasher().finish();
        let folder = base.join(format!("tabletop-{number:016x}"));
        make_private(&folder).map_err(|error| EngineError::file(&folder, &error))?;
        let session = Self { folder };
        for (name, text) in driver {
            let path = session.driver().join(name);
            let parent = path.parent().unwrap_or(&session.folder);
            fs::create_dir_all(parent)
                .and_then(|()| fs::write(&path, text))
                .map_err(|error| EngineError::file(&path, &error))?;
        }
        // What a call needs, at least.
        let request = session.folder.join("request.bin");
        fs::write(&request, [0; LEAST_ROOM])
            .map_err(|error| EngineError::file(&request, &error))?;
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

    #[test]
    #[cfg(target_os = "linux")]
    fn a_place_that_does_not_take_it_is_passed_over() {
        let bases = [PathBuf::from("/proc"), env::temp_dir()];
        let session = Session::in_one_of(bases.into_iter(), &[]).unwrap();
        assert!(session.folder().starts_with(env::temp_dir()));
        let nowhere = Session::in_one_of([PathBuf::from("/proc")].into_iter(), &[]);
        assert!(nowhere.unwrap_err().to_string().contains("/proc"));
    }
}
