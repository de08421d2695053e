//! A private folder that goes when it is not needed any more.

use std::{
    collections::hash_map::RandomState,
    env, fs,
    hash::{BuildHasher, Hasher},
    io,
    path::{Path, PathBuf},
};

use crate::error::EngineError;

/// A private folder, in memory if possible, that is removed in the end.
#[derive(Debug)]
pub(crate) struct PrivateFolder {
    path: PathBuf,
}

impl PrivateFolder {
    /// Makes the folder in the first place where `fill` can fill it.
    pub(crate) fn filled(
        fill: impl Fn(&Self) -> Result<(), EngineError>,
    ) -> Result<Self, EngineError> {
        Self::in_one_of(bases(), fill)
    }

    fn in_one_of(
        bases: impl Iterator<Item = PathBuf>,
        fill: impl Fn(&Self) -> Result<(), EngineError>,
    ) -> Result<Self, EngineError> {
        let mut result = Err(EngineError::file(
            env::temp_dir(),
            &io::ErrorKind::NotFound.into(),
        ));
        for base in bases {
            result = Self::in_place(&base).and_then(|folder| {
                fill(&folder)?;
                Ok(folder)
            });
            if result.is_ok() {
                break;
            }
        }
        result
    }

    fn in_place(base: &Path) -> Result<Self, EngineError> {
        let number = RandomState::new().build_hasher().finish();
        let path = base.join(format!("tabletop-{number:016x}"));
        make_private(&path).map_err(|error| EngineError::file(&path, &error))?;
        Ok(Self { path })
    }

    /// Its place.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file into it, and the folders on its way.
    pub(crate) fn write(&self, name: &str, contents: &[u8]) -> Result<(), EngineError> {
        let path = self.path.join(name);
        let parent = path.parent().unwrap_or(&self.path);
        fs::create_dir_all(parent)
            .and_then(|()| fs::write(&path, contents))
            .map_err(|error| EngineError::file(&path, &error))
    }
}

impl Drop for PrivateFolder {
    fn drop(&mut self) {
        // Nothing can be done about a folder that stays; it is in memory or among temporary files.
        drop(fs::remove_dir_all(&self.path));
    }
}

/// Folders in which others may be made: in memory first.
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

    fn with_script(folder: &PrivateFolder) -> Result<(), EngineError> {
        folder.write("sub/a.m", b"x = 1;")
    }

    #[test]
    fn the_folder_is_private_and_goes() {
        let folder = PrivateFolder::filled(with_script).unwrap();
        let path = folder.path().to_owned();
        assert_eq!(fs::read_to_string(path.join("sub/a.m")).unwrap(), "x = 1;");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            assert_eq!(
                fs::metadata(&path).unwrap().permissions().mode() & 0o777,
                0o700
            );
        }
        drop(folder);
        assert!(!path.exists());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_place_that_does_not_take_it_is_passed_over() {
        let bases = [PathBuf::from("/proc"), env::temp_dir()];
        let folder = PrivateFolder::in_one_of(bases.into_iter(), with_script).unwrap();
        assert!(folder.path().starts_with(env::temp_dir()));
        let nowhere = PrivateFolder::in_one_of([PathBuf::from("/proc")].into_iter(), with_script);
        assert!(nowhere.unwrap_err().to_string().contains("/proc"));
    }
}
