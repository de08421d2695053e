//! Files that ship inside the program.

use std::path::{Component, Path, PathBuf};

use bevy::prelude::*;

use crate::misspelling::nearest_name;

/// Prefix of a shipped file's name.
const PREFIX: &str = "shipped:";

/// A file that ships inside the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedFile {
    /// Its place in a working folder, with slashes: `tablesetup/default.xml`.
    pub path: &'static str,
    /// Its content.
    pub text: &'static str,
}

impl ShippedFile {
    /// The path that always means this file and never one on disk: `shipped:tablesetup/default.xml`.
    pub fn name(&self) -> PathBuf {
        format!("{PREFIX}{}", self.path).into()
    }
}

/// The files that ship inside the program, so that it can be started in any folder.
///
/// ```
/// use std::path::Path;
///
/// use tabletop_core::{ShippedFile, ShippedFiles};
///
/// let file = ShippedFile { path: "tablesetup/tower.xml", text: "<tabletop/>" };
/// let shipped = ShippedFiles::new([file]);
/// assert_eq!(shipped.find(Path::new("tablesetup/tower.xml")), Some(&file));
/// assert_eq!(shipped.find(&file.name()), Some(&file));
/// assert_eq!(shipped.find(Path::new("/tablesetup/tower.xml")), None);
/// ```
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct ShippedFiles(Vec<ShippedFile>);

impl ShippedFiles {
    /// These files, sorted by path.
    pub fn new(files: impl IntoIterator<Item = ShippedFile>) -> Self {
        let mut files: Vec<_> = files.into_iter().collect();
        files.sort_by_key(|file| file.path);
        Self(files)
    }

    /// The files in a folder and its subfolders, by path.
    pub fn in_folder(&self, folder: &str) -> impl Iterator<Item = &ShippedFile> {
        let is_inside = move |file: &&ShippedFile| Path::new(file.path).starts_with(folder);
        self.0.iter().filter(is_inside)
    }

    /// The shipped file that a path means.
    pub fn find(&self, path: &Path) -> Option<&ShippedFile> {
        let inside = self.resolve(path)?;
        self.0.iter().find(|file| Path::new(file.path) == inside)
    }

    /// The shipped file whose name is the most like that of a path that leads to nothing, among those of the same ending.
    pub fn nearest(&self, path: &Path) -> Option<&ShippedFile> {
        let name = path.file_name()?.to_str()?;
        let of_ending = |file: &&ShippedFile| Path::new(file.path).extension() == path.extension();
        let name_of = |file: &ShippedFile| file.path.rsplit('/').next().unwrap_or(file.path);
        let files: Vec<_> = self.0.iter().filter(of_ending).collect();
        let names: Vec<_> = files.iter().map(|file| name_of(file)).collect();
        let nearest = nearest_name(name, &names)?;
        files.into_iter().find(|file| name_of(file) == nearest)
    }

    /// The place in a working folder that a path means, if a file or folder is shipped there. The path is a [name](ShippedFile::name),
    /// or is relative to the working folder. A path at which something exists on disk means that, not the shipped file.
    pub fn resolve(&self, path: &Path) -> Option<PathBuf> {
        let inside = match path.to_str()?.strip_prefix(PREFIX) {
            Some(inside) => inside,
            None if path.exists() => return None,
            None => path.to_str()?,
        };
        let inside = lexical(Path::new(inside)).filter(|inside| !inside.as_os_str().is_empty())?;
        let mut files = self.0.iter();
        let is_shipped = files.any(|file| Path::new(file.path).starts_with(&inside));
        is_shipped.then_some(inside)
    }
}

/// The path that a file names, seen from that file's folder.
pub fn seen_from(folder: &Path, path: &Path) -> PathBuf {
    match is_shipped(path) {
        true => path.to_owned(),
        false => folder.join(path),
    }
}

/// True if a path is the [name](ShippedFile::name) of a shipped file.
pub fn is_shipped(path: &Path) -> bool {
    path.to_str().is_some_and(|path| path.starts_with(PREFIX))
}

/// The relative path without `.` and `..`; `None` if it leads out of its folder.
fn lexical(path: &Path) -> Option<PathBuf> {
    let mut inside = PathBuf::new();
    for component in path.components() {
        match component {
            Component::Normal(name) => inside.push(name),
            Component::CurDir => {}
            Component::ParentDir => {
                if !inside.pop() {
                    return None;
                }
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOWER: ShippedFile = ShippedFile {
        path: "tablesetup/tower.xml",
        text: "<tabletop/>",
    };
    const MANIFEST: ShippedFile = ShippedFile {
        path: "Cargo.toml",
        text: "",
    };

    fn found(path: &str) -> Option<&'static str> {
        let shipped = ShippedFiles::new([TOWER, MANIFEST]);
        shipped.find(Path::new(path)).map(|file| file.path)
    }

    #[test]
    fn a_file_of_the_working_folder_goes_first() {
        assert_eq!(found("tablesetup/tower.xml"), Some(TOWER.path));
        assert_eq!(found("Cargo.toml"), None);
        assert_eq!(found("shipped:Cargo.toml"), Some("Cargo.toml"));
    }

    #[test]
    fn paths_are_followed_and_never_lead_out() {
        for path in [
            "./tablesetup/tower.xml",
            "scenarios/../tablesetup/tower.xml",
            "shipped:scenarios/../tablesetup/./tower.xml",
        ] {
            assert_eq!(found(path), Some(TOWER.path), "{path}");
        }
        for path in [
            "../tablesetup/tower.xml",
            "/tablesetup/tower.xml",
            "shipped:../tablesetup/tower.xml",
            "tablesetup",
            "",
        ] {
            assert_eq!(found(path), None, "{path}");
        }
    }

    #[test]
    fn a_shipped_path_is_the_same_seen_from_everywhere() {
        let folder = Path::new("shipped:scenarios");
        let beside = seen_from(folder, Path::new("../tablesetup/tower.xml"));
        assert_eq!(found(beside.to_str().unwrap()), Some(TOWER.path));
        assert_eq!(seen_from(Path::new("a"), &TOWER.name()), TOWER.name());
        assert!(is_shipped(&TOWER.name()) && !is_shipped(Path::new(TOWER.path)));
    }

    #[test]
    fn a_folder_resolves_and_lists_its_files_by_path() {
        let shipped = ShippedFiles::new([TOWER, MANIFEST]);
        let resolved = shipped.resolve(Path::new("./tablesetup/"));
        assert_eq!(resolved, Some("tablesetup".into()));
        assert_eq!(shipped.resolve(Path::new("src")), None);
        assert_eq!(shipped.resolve(Path::new("")), None);
        let listed: Vec<_> = shipped.in_folder("tablesetup").collect();
        assert_eq!(listed, [&TOWER]);
        assert_eq!(shipped.in_folder("table").count(), 0);
    }
}
