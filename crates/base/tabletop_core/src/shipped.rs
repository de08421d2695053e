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

    /// The way on, at the end of a message that nothing is at a path: the file of these folders that may be meant.
    pub fn way_on(&self, path: &Path, folders: &[&str]) -> String {
        match self.nearest(path, folders) {
            _ if path.exists() => String::new(),
            Some(near) => format!("; did you mean {}?", near.path),
            None => "; `tabletop shipped` lists the files inside the program".into(),
        }
    }

    /// The shipped file of these folders whose name is the most like that of a path that leads to nothing: with its ending, without it, or, of
    /// a `robot.ron`, that of the folder around it.
    fn nearest(&self, path: &Path, folders: &[&str]) -> Option<&ShippedFile> {
        let name = path.file_name()?.to_str()?;
        let files = folders.iter().flat_map(|folder| self.in_folder(folder));
        let files: Vec<_> = files.collect();
        let robots = files.iter().filter_map(|file| {
            let (around, name) = file.path.rsplit_once('/')?;
            let robot = around.rsplit('/').next().filter(|_| name == "robot.ron")?;
            Some((robot, *file))
        });
        let whole = files.iter().map(|file| (file_name(file.path), *file));
        let stems = whole.clone().filter_map(|(name, file)| {
            let (stem, _) = name.rsplit_once('.')?;
            Some((stem, file))
        });
        let called: Vec<_> = robots.chain(whole).chain(stems).collect();
        let names: Vec<_> = called.iter().map(|(name, _)| *name).collect();
        let nearest = nearest_name(name, &names)?;
        let found = called.into_iter().find(|(name, _)| *name == nearest);
        found.map(|(_, file)| file)
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

fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
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
    fn near_files_are_found_by_their_names() {
        let file = |path| ShippedFile { path, text: "" };
        let shipped = ShippedFiles::new([
            file("assets/panda/panda.urdf"),
            file("assets/panda/robot.ron"),
            file("scenarios/tower.ron"),
            TOWER,
        ]);
        let near = |path, folder| {
            shipped
                .nearest(Path::new(path), &[folder])
                .map(|it| it.path)
        };
        assert_eq!(near("panda", "assets"), Some("assets/panda/robot.ron"));
        assert_eq!(near("pnda.urdf", "assets"), Some("assets/panda/panda.urdf"));
        assert_eq!(near("there/towr", "scenarios"), Some("scenarios/tower.ron"));
        assert_eq!(near("tower.xlm", "tablesetup"), Some(TOWER.path));
        assert_eq!(near("bridge", "scenarios"), None);
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
