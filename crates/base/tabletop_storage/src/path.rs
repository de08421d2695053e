//! Paths and the things at them.

use std::{
    io::{self, ErrorKind},
    path::{Path, PathBuf, absolute},
};

/// True if there is something of this name, be it a link to nothing.
pub fn is_taken(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// The folder that holds a path.
///
/// ```
/// use std::path::Path;
/// use tabletop_storage::parent_of;
///
/// assert_eq!(parent_of(Path::new("demo")), Path::new("."));
/// assert_eq!(parent_of(Path::new("a/demo")), Path::new("a"));
/// ```
pub fn parent_of(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| *parent != Path::new(""));
    parent.unwrap_or(Path::new("."))
}

/// The path without links, be there anything at its end or not.
pub fn canonical(path: &Path) -> PathBuf {
    let path = absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = path.ancestors().find_map(|folder| {
        let rest = path.strip_prefix(folder).ok()?;
        Some(folder.canonicalize().ok()?.join(rest))
    });
    there.unwrap_or(path).components().collect()
}

/// Makes sure that a path is that of a folder, and no link to one.
///
/// # Errors
/// It is something else, or it is not there.
pub fn require_folder(path: &Path) -> io::Result<()> {
    match path.symlink_metadata()?.is_dir() {
        true => Ok(()),
        false => Err(io::Error::new(
            ErrorKind::NotADirectory,
            "it is no folder, and a recording has one there",
        )),
    }
}

/// Names beside a path that begin with a dot: `.NAME.new-`, to which numbers are appended.
pub(crate) fn hidden_prefix(path: &Path) -> String {
    let name = path.components().next_back();
    let name = name.map(|name| name.as_os_str().to_string_lossy().into_owned());
    format!(".{}.new-", name.unwrap_or_default())
}

/// The path with the first number appended, from 1, at which there is nothing.
pub(crate) fn first_free_name(path: &Path) -> PathBuf {
    let numbered = |number: u32| {
        let mut name = path.components().as_path().as_os_str().to_owned();
        name.push(format!("-{number}"));
        PathBuf::from(name)
    };
    let mut number = 1;
    while is_taken(&numbered(number)) {
        number += 1;
    }
    numbered(number)
}
