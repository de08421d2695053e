//! Differences between recordings.

use std::{
    collections::BTreeSet,
    fs::{self, File},
    io::{self, Read as _},
    path::Path,
};

use tabletop_recorder::{NOTES, whole_lines};
use tabletop_storage::{InnerFile, InnerPath};
use tabletop_task::Requirements;

use crate::ReplayError;

/// Number of bytes by which a recorded file is read beyond the length of the replayed one: a difference is told with a line of it.
const MOST_BEYOND: u64 = 4096;

/// Number of characters of a line that are shown, at most.
const MOST_SHOWN: usize = 200;

/// Number of those that are before the difference, in a line that is not shown in full.
const SHOWN_BEFORE: usize = 50;

/// The first file in which two recordings differ, and the difference. The second one was made by this program.
///
/// # Errors
///
/// A folder or file cannot be read.
pub fn first_difference(recorded: &Path, replayed: &Path) -> Result<Option<String>, ReplayError> {
    first_of(recorded, replayed, true)
}

/// [`first_difference`] with or without pictures.
pub(super) fn first_of(
    recorded: &Path,
    replayed: &Path,
    with_pictures: bool,
) -> Result<Option<String>, ReplayError> {
    let mut files = files_in(recorded)?;
    files.extend(files_in(replayed)?);
    files.retain(|file| with_pictures || !is_picture(file.as_path()));
    first_that_differs(files, [recorded, replayed], |_, before, after| {
        before == after
    })
}

/// [`first_of`] for a recording that was cut off: its files are beginnings, and the last ones are missing.
pub(super) fn first_before_cut(
    recorded: &Path,
    replayed: &Path,
    with_pictures: bool,
) -> Result<Option<String>, ReplayError> {
    let mut files = files_in(recorded)?;
    files.retain(|file| with_pictures || !is_picture(file.as_path()));
    first_that_differs(files, [recorded, replayed], |file, before, after| {
        after.starts_with(match is_picture(file) {
            true => before,
            false => whole_lines(before),
        })
    })
}

/// The first of these files that exists in only one of two folders, or differs between them, and the difference.
fn first_that_differs(
    files: BTreeSet<InnerPath>,
    [recorded, replayed]: [&Path; 2],
    is_same: impl Fn(&Path, &[u8], &[u8]) -> bool,
) -> Result<Option<String>, ReplayError> {
    for file in files {
        let [before, after] =
            [recorded, replayed].map(|folder| InnerFile::new(folder, file.clone()));
        let file = file.as_path();
        let name = file.display();
        let difference = match (before.is_taken(), after.is_taken()) {
            (true, false) => format!("{name}: was recorded, but is missing in the replay"),
            (false, true) => format!("{name}: was not recorded, but exists in the replay"),
            _ => {
                let recorded = open(&before)?;
                let after = first_bytes(&after.path(), open(&after)?, u64::MAX)?;
                let most = (after.len() as u64).saturating_add(MOST_BEYOND);
                let before = first_bytes(&before.path(), recorded, most)?;
                if is_same(file, &before, &after) {
                    continue;
                }
                match is_picture(file) {
                    true => format!("{name}: the pictures differ"),
                    false => format!("{name}: {}", first_difference_of(&before, &after)),
                }
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

fn is_picture(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension == "png")
}

/// The difference between two texts: the number of the first differing line, and the difference.
fn first_difference_of(before: &[u8], after: &[u8]) -> String {
    let [mut before, mut after] =
        [before, after].map(|text| text.split_inclusive(|byte| *byte == b'\n'));
    for number in 1.. {
        let (was, is) = (before.next(), after.next());
        if was != is || was.is_none() {
            let [was, is] = excerpts([was, is]);
            return format!("line {number}: recorded {was}, replayed {is}");
        }
    }
    String::new()
}

/// Excerpts of two lines: the whole lines, or, if one is long, the surroundings of the first difference.
fn excerpts(lines: [Option<&[u8]>; 2]) -> [String; 2] {
    let lines = lines.map(|line| {
        let text = String::from_utf8_lossy(line?);
        let text = text.trim_end_matches('\n').replace('\r', "\\r");
        Some(text.chars().collect::<Vec<_>>())
    });
    let [was, is] = lines.each_ref().map(|line| line.iter().flatten());
    let longest = was.clone().count().max(is.clone().count());
    let from = match longest > MOST_SHOWN {
        true => was.zip(is).take_while(|(was, is)| was == is).count(),
        false => 0,
    };
    let from = from.saturating_sub(SHOWN_BEFORE);
    lines.map(|line| match line {
        Some(line) => {
            let shown: String = line.iter().skip(from).take(MOST_SHOWN).collect();
            let ellipsis = |is_left_out| if is_left_out { "…" } else { "" };
            let (before, after) = (ellipsis(from > 0), ellipsis(line.len() > from + MOST_SHOWN));
            format!("`{before}{shown}{after}`")
        }
        None => "the end of the file".to_owned(),
    })
}

/// The files that a recorder writes to a recording's folder, relative to it, in alphabetical order; without those that are for the
/// program alone.
fn files_in(folder: &Path) -> Result<BTreeSet<InnerPath>, ReplayError> {
    let mut files = BTreeSet::new();
    let mut folders = vec![None];
    while let Some(inner) = folders.pop() {
        let path = inner.as_ref().map(|inner: &InnerPath| inner.below(folder));
        let path = path.unwrap_or_else(|| folder.to_owned());
        let failed = failed(&path);
        for entry in fs::read_dir(&path).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let name = InnerPath::name(entry.file_name());
            let name = name.map_err(|error| failed(io::Error::other(error)))?;
            let name = inner
                .as_ref()
                .map_or(name.clone(), |inner| inner.then(&name));
            if is_for_the_program_alone(name.as_path()) {
                continue;
            }
            match entry.file_type().map_err(failed)?.is_dir() {
                true => folders.push(Some(name)),
                // Requirements on objects are not recorded.
                false
                    if [Requirements::FILE, NOTES]
                        .map(Path::new)
                        .contains(&name.as_path()) => {}
                false => {
                    files.insert(name);
                }
            }
        }
    }
    Ok(files)
}

/// Number of bytes of these files.
pub(super) fn bytes_in(folder: &Path) -> Result<u64, ReplayError> {
    let bytes = |file: InnerPath| {
        let path = file.below(folder);
        let found = path.symlink_metadata().map_err(failed(&path))?;
        Ok(found.len())
    };
    files_in(folder)?.into_iter().map(bytes).sum()
}

fn open(file: &InnerFile) -> Result<File, ReplayError> {
    file.open().map_err(failed(&file.path()))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_that_differs_is_shown() {
        for (before, after, difference) in [
            ("a\nb\n", "a\nc\n", "line 2: recorded `b`, replayed `c`"),
            ("a\r\n", "a\n", "line 1: recorded `a\\r`, replayed `a`"),
            (
                "a\n",
                "a\nb\n",
                "line 2: recorded the end of the file, replayed `b`",
            ),
            ("a", "a\n", "line 1: recorded `a`, replayed `a`"),
        ] {
            let found = first_difference_of(before.as_bytes(), after.as_bytes());
            assert_eq!(found, difference);
        }
        let found = first_difference_of(b"\xff\n", b"\xfe\n");
        assert_eq!(found, "line 1: recorded `\u{fffd}`, replayed `\u{fffd}`");
    }

    #[test]
    fn a_long_line_is_shown_around_the_difference() {
        let [before, after] =
            ["1", "2"].map(|it| format!("{}{it}{}", "ä".repeat(300), "b".repeat(300)));
        let found = first_difference_of(before.as_bytes(), after.as_bytes());
        let shown = |it| format!("`…{}{it}{}…`", "ä".repeat(50), "b".repeat(149));
        let [before, after] = ["1", "2"].map(shown);
        assert_eq!(
            found,
            format!("line 1: recorded {before}, replayed {after}")
        );
        let found = first_difference_of(&[b'a'; 1000], b"");
        let shown = format!("`{}…`", "a".repeat(200));
        assert_eq!(
            found,
            format!("line 1: recorded {shown}, replayed the end of the file")
        );
    }
}
