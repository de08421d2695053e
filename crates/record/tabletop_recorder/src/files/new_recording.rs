//! The placement of a new recording: its folder appears whole, and an earlier recording there is moved aside.

use std::{
    io::{self, Read as _},
    path::{Path, PathBuf},
};

use tabletop_storage::{
    LockedFolder, Storage, Symlinks, WriterLock, is_taken, open_regular_file, parent_of,
};

use crate::{error::RecorderError, files::folder::Folder};

/// The beginning of a session log: of all files, only this program's recordings have one.
const BEGINNING: &[u8] = b"{\"format\":";

/// A new recording in its place.
#[derive(Debug)]
pub(crate) struct NewRecording<T> {
    pub(crate) opened: T,
    /// The path of the earlier recording that was in its place.
    pub(crate) moved_aside: Option<PathBuf>,
}

/// The thing at the place of a new recording.
pub(crate) enum Occupant {
    Nothing,
    EmptyFolder,
    /// An earlier recording, or a link to one or to an empty folder.
    Earlier,
}

impl<T> NewRecording<T> {
    /// Fills a folder under a hidden name, gives it this one, and opens it. An earlier recording is moved aside to the same name with the
    /// first free number appended, unless a program is recording into it. If anything fails, nothing has changed.
    pub(crate) fn of<F>(
        path: &Path,
        storage: &Storage,
        fill: impl FnOnce(&Folder) -> Result<F, RecorderError>,
        open: impl FnOnce(Folder, F) -> Result<T, RecorderError>,
    ) -> Result<Self, RecorderError> {
        let folder = Folder::at(path, storage);
        let parent = parent_of(path);
        storage
            .create_folders(parent)
            .map_err(RecorderError::create(path))?;
        let _alone = WriterLock::of_place(path, storage).map_err(RecorderError::create(path))?;
        let occupant = occupant(&folder)?;
        let draft = LockedFolder::beside(path, storage).map_err(RecorderError::create(path))?;
        let hidden = Folder::at(draft.path(), storage);
        let placed = fill(&hidden).and_then(|filled| {
            draft.unlock().map_err(RecorderError::create(path))?;
            take_the_place(&folder, &hidden, &occupant, |folder| open(folder, filled))
        });
        if placed.is_err() {
            // The failure is reported; more cannot be done.
            let _ = hidden.remove();
        }
        placed
    }
}

/// Gives a hidden folder the name of another, and opens it there. If anything fails, all is as before.
pub(crate) fn take_the_place<T>(
    folder: &Folder,
    hidden: &Folder,
    occupant: &Occupant,
    open: impl FnOnce(Folder) -> Result<T, RecorderError>,
) -> Result<NewRecording<T>, RecorderError> {
    let storage = folder.storage();
    let (path, hidden) = (folder.path(), hidden.path());
    let moved_aside = match occupant {
        Occupant::Nothing | Occupant::EmptyFolder => None,
        Occupant::Earlier => Some(move_aside(folder)?),
    };
    let placed = match occupant {
        Occupant::EmptyFolder => storage.rename_onto_empty(hidden, path),
        Occupant::Nothing | Occupant::Earlier => storage.rename(hidden, path),
    };
    let is_placed = placed.is_ok();
    let opened = placed
        .map_err(RecorderError::create(path))
        .and_then(|()| open(folder.clone()));
    match opened {
        Ok(opened) => Ok(NewRecording {
            opened,
            moved_aside,
        }),
        Err(error) => {
            // The failure is reported; more cannot be done.
            if is_placed {
                let _ = storage.rename(path, hidden);
            }
            let _ = match (occupant, &moved_aside) {
                (Occupant::Earlier, Some(aside)) => storage.rename(aside, path),
                (Occupant::EmptyFolder, _) if !is_taken(path) => storage.create_folder(path),
                (Occupant::Nothing | Occupant::EmptyFolder | Occupant::Earlier, _) => Ok(()),
            };
            Err(error)
        }
    }
}

fn move_aside(folder: &Folder) -> Result<PathBuf, RecorderError> {
    let moved = folder.storage().move_aside(folder.path());
    moved.map_err(|(aside, source)| RecorderError::MoveAside {
        folder: folder.path().to_owned(),
        aside,
        source,
    })
}

/// Finds the occupant of a folder's name. Only an empty folder and a recording that nobody is making may be in the way.
pub(crate) fn occupant(folder: &Folder) -> Result<Occupant, RecorderError> {
    let path = folder.path();
    if !is_taken(path) {
        return Ok(Occupant::Nothing);
    }
    if !path.is_dir() {
        return Err(RecorderError::NoFolder {
            path: path.to_owned(),
        });
    }
    if is_in_use(folder) {
        return Err(RecorderError::InUse {
            folder: path.to_owned(),
        });
    }
    let entries = folder.storage().entries(path);
    let is_empty = entries.map_err(RecorderError::read(path))?.is_empty();
    if is_empty && !path.is_symlink() {
        Ok(Occupant::EmptyFolder)
    } else if is_empty || is_recording(folder) {
        Ok(Occupant::Earlier)
    } else {
        Err(RecorderError::NoRecording {
            folder: path.to_owned(),
        })
    }
}

fn is_in_use(folder: &Folder) -> bool {
    let session = folder.storage().open_to_read(&folder.session());
    session.is_ok_and(|session| !session.lock_unless(|| false))
}

/// True if a folder has a session log.
fn is_recording(folder: &Folder) -> bool {
    let beginning = || -> io::Result<Vec<u8>> {
        let session = open_regular_file(&folder.session(), Symlinks::Refused)?;
        let mut beginning = Vec::new();
        session
            .take(BEGINNING.len() as u64)
            .read_to_end(&mut beginning)?;
        Ok(beginning)
    };
    beginning().is_ok_and(|beginning| beginning == BEGINNING)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::files::log_file::LogFile;

    /// A new folder of a test.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("tabletop_{name}_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Fills a recording that has this content besides its session log.
    fn filled(folder: &Folder, content: &str) -> Result<(), RecorderError> {
        fs::write(folder.session(), "{\"format\":4}\n").unwrap();
        fs::write(folder.path().join("content"), content).unwrap();
        Ok(())
    }

    fn place(path: &Path) -> Result<NewRecording<()>, RecorderError> {
        let fill = |folder: &Folder| filled(folder, "new");
        NewRecording::of(path, &Storage::default(), fill, |_, ()| Ok(()))
    }

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn earlier_recordings_are_moved_aside_to_the_first_free_number() {
        let parent = folder("earlier");
        let demo = parent.join("demo/");
        let storage = Storage::default();
        let mut moved = Vec::new();
        for content in ["first", "second", "third"] {
            let fill = |folder: &Folder| filled(folder, content);
            let new = NewRecording::of(&demo, &storage, fill, |_, ()| Ok(())).unwrap();
            moved.push(new.moved_aside);
        }
        let aside = |number| Some(parent.join(format!("demo-{number}")));
        assert_eq!(moved, [None, aside(1), aside(2)]);
        let full = || RecorderError::write(&demo)(io::Error::other("full"));
        let unfilled = NewRecording::of(&demo, &storage, |_| Err::<(), _>(full()), |_, ()| Ok(()));
        unfilled.unwrap_err();
        let unopened = NewRecording::of(&demo, &storage, |_| Ok(()), |_, ()| Err::<(), _>(full()));
        unopened.unwrap_err();
        assert_eq!(names_in(&parent), ["demo", "demo-1", "demo-2"]);
        for (folder, content) in [("demo", "third"), ("demo-1", "first"), ("demo-2", "second")] {
            let path = parent.join(folder).join("content");
            assert_eq!(fs::read_to_string(path).unwrap(), content);
        }
        fs::remove_dir_all(parent).unwrap();
    }

    #[test]
    fn a_folder_with_anything_else_stays() {
        let parent = folder("other");
        for (name, text) in [("notes.txt", "mine"), ("session.jsonl", "{\"mine\":1}")] {
            let demo = parent.join("demo");
            fs::create_dir(&demo).unwrap();
            fs::write(demo.join(name), text).unwrap();
            let error = place(&demo).unwrap_err().to_string();
            assert!(error.contains("something else than a recording"), "{error}");
            assert_eq!(names_in(&parent), ["demo"]);
            assert_eq!(fs::read_to_string(demo.join(name)).unwrap(), text);
            fs::remove_dir_all(demo).unwrap();
        }
        fs::remove_dir_all(parent).unwrap();
    }

    #[test]
    fn an_empty_folder_is_filled_and_comes_back_if_that_fails() {
        let parent = folder("empty");
        let demo = parent.join("demo");
        fs::create_dir(&demo).unwrap();
        let full = || RecorderError::write(&demo)(io::Error::other("full"));
        let storage = Storage::default();
        let unopened = NewRecording::of(&demo, &storage, |_| Ok(()), |_, ()| Err::<(), _>(full()));
        unopened.unwrap_err();
        assert_eq!(names_in(&demo), [""; 0]);
        assert_eq!(place(&demo).unwrap().moved_aside, None);
        assert_eq!(names_in(&parent), ["demo"]);
        fs::remove_dir_all(parent).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn hidden_folders_of_others_stay() {
        let parent = folder("hidden");
        let demo = parent.join("demo");
        let others = [".demo.new-7", ".demo.new-mine"].map(|name| parent.join(name));
        for other in &others {
            fs::create_dir(other).unwrap();
            fs::write(other.join("file"), "mine").unwrap();
        }
        let left = LockedFolder::beside(&demo, &Storage::default()).unwrap();
        let running = LockedFolder::beside(&demo, &Storage::default()).unwrap();
        let left = {
            let path = left.path().to_owned();
            fs::write(path.join("file"), "of a killed program").unwrap();
            drop(left);
            path
        };
        place(&demo).unwrap();
        assert!(others.iter().all(|other| other.join("file").exists()));
        assert!(running.path().exists(), "its program runs");
        assert!(!left.exists(), "its program was killed");
        fs::remove_dir_all(parent).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_into_which_is_recorded_stays_where_it_is() {
        let parent = folder("locked");
        let demo = parent.join("demo");
        let storage = Storage::default();
        let begin = || {
            let fill = |folder: &Folder| {
                let mut session = LogFile::create(&storage, folder.session())?;
                session.append(b"{\"format\":4}\n")?;
                Ok(session)
            };
            NewRecording::of(&demo, &storage, fill, |_, session| {
                session.lock();
                Ok(session)
            })
        };
        let session = begin().unwrap();
        let error = begin().unwrap_err().to_string();
        assert!(error.starts_with("a recording is being made in"), "{error}");
        drop(session);
        drop(begin().unwrap());
        let file = demo.join("session.jsonl");
        let error = place(&file).unwrap_err().to_string();
        assert!(
            error.ends_with("is a file; record into a folder"),
            "{error}"
        );
        assert!(file.exists());
        fs::remove_dir_all(parent).unwrap();
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let error = place(Path::new("/dev/null/demo")).unwrap_err();
        assert!(error.to_string().contains("/dev/null/demo"), "{error}");
    }
}
