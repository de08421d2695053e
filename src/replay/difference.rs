//! Differences between recordings.

use std::{
    collections::BTreeSet,
    fs::{self, File},
    io::{self, Read as _},
    path::{Path, PathBuf},
};

use tabletop_core::{Symlinks, open_regular_file};
use tabletop_recorder::whole_lines;
use tabletop_task::Requirements;

use super::ReplayError;

/// Number of bytes by which a recorded file is read beyond the length of the replayed one: a difference is told with a line of it.
const MOST_BEYOND: u64 = 4096;

/// Number of characters of a line that are shown, at most.
const MOST_SHOWN: usize = 200;

/// The first file in which two recordings differ, and the difference. The second one was made by this program.
///
/// # Errors
///
/// A folder or file cannot be read.
pub fn first_difference(recorded: &Path, replayed: &Path) -> Result<Option<String>, ReplayError> {
    let mut files = files_in(recorded)?;
    files.extend(files_in(replayed)?);
    first_that_differs(files, [recorded, replayed], |_, before, after| {
        before == after
    })
}

/// [`first_difference`] for a recording that was cut off: its files are beginnings, and the last ones are missing.
pub(super) fn first_before_cut(
    recorded: &Path,
    replayed: &Path,
) -> Result<Option<String>, ReplayError> {
    let files = files_in(recorded)?;
    first_that_differs(files, [recorded, replayed], |file, before, after| {
        let is_picture = file.extension().is_some_and(|extension| extension == "png");
        after.starts_with(match is_picture {
            true => before,
            false => whole_lines(before),
        })
    })
}

/// The first of these files that exists in only one of two folders, or differs between them, and the difference.
fn first_that_differs(
    files: BTreeSet<PathBuf>,
    [recorded, replayed]: [&Path; 2],
    is_same: impl Fn(&Path, &[u8], &[u8]) -> bool,
) -> Result<Option<String>, ReplayError> {
    for file in files {
        let name = file.display();
        let (before, after) = (recorded.join(&file), replayed.join(&file));
        let difference = match (is_there(&before), is_there(&after)) {
            (true, false) => format!("{name}: was recorded, but is missing in the replay"),
            (false, true) => format!("{name}: was not recorded, but exists in the replay"),
            _ => {
                let recorded = open(&before)?;
                let after = first_bytes(&after, open(&after)?, u64::MAX)?;
                let most = (after.len() as u64).saturating_add(MOST_BEYOND);
                let before = first_bytes(&before, recorded, most)?;
                if is_same(&file, &before, &after) {
                    continue;
                }
                format!("{name}: {}", first_difference_of(&before, &after))
            }
        };
        return Ok(Some(difference));
    }
    Ok(None)
}

/// True if it is unfinished, or hidden as undone segments are.
fn is_for_the_program_alone(file: &Path) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with('.') || name.ends_with(".part")
}

/// The difference between two files: line and texts, or for pictures just that they differ.
fn first_difference_of(before: &[u8], after: &[u8]) -> String {
    let (Ok(before), Ok(after)) = (std::str::from_utf8(before), std::str::from_utf8(after)) else {
        return "the pictures differ".into();
    };
    let [mut before, mut after] = [before, after].map(|text| text.split_inclusive('\n'));
    let shown = |line: Option<&str>| match line.map(|line| line.trim_end_matches('\n')) {
        Some(line) => {
            let end = line.char_indices().nth(MOST_SHOWN).map(|(end, _)| end);
            let text = line[..end.unwrap_or(line.len())].replace('\r', "\\r");
            let more = end.map_or("", |_| "…");
            format!("`{text}{more}`")
        }
        None => "the end of the file".to_owned(),
    };
    for line in 1.. {
        let (was, is) = (before.next(), after.next());
        if was != is || was.is_none() {
            return format!(
                "line {line}: recorded {}, replayed {}",
                shown(was),
                shown(is)
            );
        }
    }
    String::new()
}

/// The files that a recorder writes to a recording's folder, relative to it, in alphabetical order; without those that are for the
/// program alone.
fn files_in(folder: &Path) -> Result<BTreeSet<PathBuf>, ReplayError> {
    let mut files = BTreeSet::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inner) = folders.pop() {
        let path = folder.join(&inner);
        let failed = failed(&path);
        for entry in fs::read_dir(&path).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = inner.join(entry.file_name());
            if is_for_the_program_alone(&name) {
                continue;
            }
            match entry.file_type().map_err(failed)?.is_dir() {
                true => folders.push(name),
                // Requirements on objects are not recorded.
                false if name == Path::new(Requirements::FILE) => {}
                false => {
                    files.insert(name);
                }
            }
        }
    }
    Ok(files)
}

/// True if there is something of this name, be it a link to nothing.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

fn open(path: &Path) -> Result<File, ReplayError> {
    open_regular_file(path, Symlinks::Refused).map_err(failed(path))
}

/// The first bytes of a file, at most this many.
fn first_bytes(path: &Path, file: File, most: u64) -> Result<Vec<u8>, ReplayError> {
    let mut bytes = Vec::new();
    let read = file.take(most).read_to_end(&mut bytes);
    read.map(|_| bytes).map_err(failed(path))
}

fn failed(path: &Path) -> impl Fn(io::Error) -> ReplayError + Copy {
    move |source| ReplayError::Io {
        path: path.to_owned(),
        source,
    }
}
