//! Kinds of files that a path can name.

use std::path::{Path, PathBuf};

/// Something that can be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum FileKind {
    Task,
    /// A recording in this folder.
    Recording(PathBuf),
}

impl FileKind {
    /// The kind of file that a path names, or the reason why it cannot be opened. Every file of a recording names the recording.
    pub fn of(path: &Path) -> Result<Self, String> {
        let is_task = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("xml"));
        if !path.exists() {
            return Err(format!("{} is not there", path.display()));
        }
        if is_task && path.is_file() {
            return Ok(Self::Task);
        }
        // A picture is in a subfolder of the recording's folder.
        let folders = path.ancestors().take(3);
        let mut recordings = folders.filter(|folder| folder.join("session.jsonl").is_file());
        match recordings.next() {
            Some(folder) => Ok(Self::Recording(folder.to_owned())),
            None => Err(format!(
                "{} cannot be opened: it is neither a task file (.xml) nor a recording (a folder with a session.jsonl)",
                path.display()
            )),
        }
    }
}
