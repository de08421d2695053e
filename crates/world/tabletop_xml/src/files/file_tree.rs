//! The files that a task file may name: those in its folder and below.

use std::{
    io::{self, Read as _},
    path::{Component, Path, PathBuf},
};

use tabletop_core::{ShippedFiles, is_shipped};
use tabletop_storage::{Symlinks, open_regular_file};

use crate::elements::value::ValueError;

/// The files that a task file may name.
#[derive(Debug)]
pub(crate) enum FileTree<'s> {
    /// None: its text is in memory, so there is no folder.
    Absent,
    /// Files on disk, in its folder and below.
    Disk {
        /// The folder, without links.
        root: PathBuf,
        /// Further folders, which the user allows.
        allowed: Vec<PathBuf>,
    },
    /// Files inside the program, in its folder and below.
    Shipped(&'s ShippedFiles),
}

/// The path of a file of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TaskPath {
    /// The path as faults show it.
    pub shown: PathBuf,
    /// The one path of the file, without links.
    pub true_path: PathBuf,
}

impl<'s> FileTree<'s> {
    /// The files around a task file on the disk.
    pub fn on_disk(task: &Path, allowed: &[PathBuf]) -> io::Result<Self> {
        Ok(Self::Disk {
            root: folder_of(task).canonicalize()?,
            allowed: allowed
                .iter()
                .filter_map(|folder| folder.canonicalize().ok())
                .collect(),
        })
    }

    /// The task file itself.
    pub fn task(&self, path: &Path) -> TaskPath {
        let true_path = match self {
            Self::Disk { .. } => path.canonicalize().unwrap_or(path.to_owned()),
            Self::Absent | Self::Shipped(_) => path.to_owned(),
        };
        TaskPath {
            shown: path.to_owned(),
            true_path,
        }
    }

    /// The file that another one names. The path starts from the folder of the naming file, then from the folder of the
    /// task file. Missing folders at its beginning are left out: paths of the later program begin at its working
    /// folder (`tablesetup/def-lid.xml`).
    pub fn find(
        &self,
        task: &TaskPath,
        naming: &TaskPath,
        written: &str,
    ) -> Result<TaskPath, ValueError> {
        let refused = |problem: &str| ValueError::new(written, problem, self.expected());
        if let Self::Absent = self {
            return Err(refused("cannot be read by a text without a folder"));
        }
        let written = PathBuf::from(written.trim().replace('\\', "/"));
        if self.leads_out(naming, &written) {
            return Err(refused("leads out of the folder of the task file"));
        }
        let mut problem = "is not there";
        for path in candidates(task, naming, &written) {
            match self.look_at(&path) {
                Look::File(true_path) => {
                    return Ok(TaskPath {
                        shown: path,
                        true_path,
                    });
                }
                Look::Outside => problem = "leads out of the folder of the task file",
                Look::NoFile => problem = "is not a file",
                Look::Nothing => {}
            }
        }
        Err(refused(problem))
    }

    /// The bytes of a file that [was found](Self::find), at most one more than `most`.
    pub fn read(&self, file: &TaskPath, most: usize) -> io::Result<Vec<u8>> {
        match self {
            Self::Absent => Err(io::ErrorKind::NotFound.into()),
            Self::Shipped(files) => match files.find(&file.shown) {
                Some(file) => Ok(file.text.as_bytes().to_vec()),
                None => Err(io::ErrorKind::NotFound.into()),
            },
            Self::Disk { .. } => read_file(&file.true_path, most),
        }
    }

    fn expected(&self) -> String {
        match self {
            Self::Absent => "a task file on the disk".into(),
            Self::Shipped(_) => "a file inside the program".into(),
            Self::Disk { root, .. } => format!("a file in {} or below", root.display()),
        }
    }

    /// True if a path leads out by its text alone, so that nothing needs to be looked up.
    fn leads_out(&self, naming: &TaskPath, written: &Path) -> bool {
        let depth = match self {
            Self::Absent => 0,
            // Their paths never lead out.
            Self::Shipped(_) => usize::MAX / 2,
            Self::Disk { allowed, .. } if !allowed.is_empty() => return false,
            Self::Disk { root, .. } => {
                let inside = folder_of(&naming.true_path).strip_prefix(root);
                inside.map_or(0, |inside| inside.components().count())
            }
        };
        let mut depth = Some(depth);
        for component in written.components() {
            depth = depth.and_then(|depth| match component {
                Component::Normal(_) => Some(depth + 1),
                Component::CurDir => Some(depth),
                Component::ParentDir => depth.checked_sub(1),
                Component::RootDir | Component::Prefix(_) => None,
            });
        }
        depth.is_none()
    }

    fn look_at(&self, path: &Path) -> Look {
        match self {
            Self::Absent => Look::Nothing,
            Self::Shipped(files) => match files.find(path).filter(|_| is_shipped(path)) {
                Some(file) => Look::File(file.name()),
                None => Look::Nothing,
            },
            Self::Disk { root, allowed } => {
                let Ok(true_path) = path.canonicalize() else {
                    return Look::Nothing;
                };
                let mut folders = std::iter::once(root).chain(allowed);
                if !folders.any(|folder| true_path.starts_with(folder)) {
                    return Look::Outside;
                }
                match true_path.is_file() {
                    true => Look::File(true_path),
                    false => Look::NoFile,
                }
            }
        }
    }
}

/// The thing at a path.
enum Look {
    File(PathBuf),
    /// Something that is no file: a folder, a device, a pipe.
    NoFile,
    /// Something that the task file may not name.
    Outside,
    Nothing,
}

/// The paths that a written path can mean, the likeliest first.
fn candidates(task: &TaskPath, naming: &TaskPath, written: &Path) -> Vec<PathBuf> {
    let folders = [folder_of(&naming.shown), folder_of(&task.shown)];
    let mut paths = Vec::new();
    let mut rest = written.components();
    while !rest.as_path().as_os_str().is_empty() {
        for folder in folders {
            let path = match folder == Path::new(".") {
                true => rest.as_path().to_owned(),
                false => folder.join(rest.as_path()),
            };
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
        if !matches!(rest.next(), Some(Component::Normal(_) | Component::CurDir)) {
            break;
        }
    }
    paths
}

/// The folder of a file.
fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The bytes of a file on the disk, at most one more than `most`.
pub(crate) fn read_file(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let file = open_regular_file(path, Symlinks::Followed)?;
    let mut bytes = Vec::new();
    file.take(most as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
