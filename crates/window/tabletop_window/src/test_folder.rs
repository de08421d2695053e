//! Folders of tests.

use std::{
    env, fs,
    ops::Deref,
    path::{Path, PathBuf},
    process,
};

/// A new folder, which is removed with the test.
pub(crate) struct TestFolder(PathBuf);

impl TestFolder {
    pub fn new(name: &str) -> Self {
        let folder = env::temp_dir().join(format!("tabletop-{name}-{}", process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// Writes a file, with the folders that it needs.
    pub fn write(&self, path: &str, text: &str) {
        let path = self.0.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

impl Deref for TestFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _stays = fs::remove_dir_all(&self.0);
    }
}
