//! Renaming and discarding recordings: nothing is ever replaced or removed.

use std::path::{Path, PathBuf};

use tabletop_storage::{Storage, is_taken, parent_of};
use tabletop_user::{NextTake, TRASH};

/// Gives a recording another name beside it.
pub(super) fn rename(recording: &Path, name: &str) -> Result<(), String> {
    let name = NextTake::usable_name(name);
    let place = recording.with_file_name(name.trim());
    if name.trim().is_empty() {
        return Err("a recording needs a name".into());
    }
    if place == recording {
        return Ok(());
    }
    if is_taken(&place) {
        let place = place.display();
        return Err(format!("{place} exists already; choose another name"));
    }
    let renamed = Storage::default().rename(recording, &place);
    renamed.map_err(|error| format!("{} cannot be renamed: {error}", recording.display()))
}

/// Moves a recording to the trash beside it, under the first free name, and returns its place there.
pub(super) fn discard(recording: &Path) -> Result<PathBuf, String> {
    let storage = Storage::default();
    let failed = |error| {
        format!(
            "{} cannot be moved to the trash: {error}",
            recording.display()
        )
    };
    let trash = parent_of(recording).join(TRASH);
    storage.create_folders(&trash).map_err(failed)?;
    let name = recording.file_name().unwrap_or_default().to_string_lossy();
    let names = (1..).map(|number| format!("{name}-{number}"));
    let mut places = [name.clone().into_owned()].into_iter().chain(names);
    let place = places.find_map(|name| Some(trash.join(name)).filter(|place| !is_taken(place)));
    let place = place.unwrap_or_else(|| trash.join(&*name));
    storage.rename(recording, &place).map_err(failed)?;
    Ok(place)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::test_folder::TestFolder;

    fn shelf(name: &str) -> TestFolder {
        let folder = TestFolder::new(&format!("shelf-{name}"));
        for recording in ["a-01", "a-02"] {
            folder.write(&format!("{recording}/session.jsonl"), recording);
        }
        folder
    }

    fn read(shelf: &TestFolder, file: &str) -> String {
        fs::read_to_string(shelf.join(file)).unwrap()
    }

    #[test]
    fn a_rename_never_takes_the_place_of_another() {
        let shelf = shelf("rename");
        let from = shelf.join("a-01");
        let error = rename(&from, "a-02").unwrap_err();
        assert!(error.contains("exists already"), "{error}");
        assert!(rename(&from, " ").is_err());
        rename(&from, "a-01").unwrap();
        rename(&from, "../best").unwrap();
        assert_eq!(read(&shelf, "best/session.jsonl"), "a-01");
        assert_eq!(read(&shelf, "a-02/session.jsonl"), "a-02");
    }

    #[test]
    fn discarded_recordings_of_one_name_are_all_in_the_trash() {
        let shelf = shelf("discard");
        assert_eq!(
            discard(&shelf.join("a-01")).unwrap(),
            shelf.join("trash/a-01")
        );
        shelf.write("a-01/session.jsonl", "another");
        assert_eq!(
            discard(&shelf.join("a-01")).unwrap(),
            shelf.join("trash/a-01-1")
        );
        assert_eq!(read(&shelf, "trash/a-01/session.jsonl"), "a-01");
        assert_eq!(read(&shelf, "trash/a-01-1/session.jsonl"), "another");
        assert!(!shelf.join("a-01").exists());
    }
}
