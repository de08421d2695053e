//! Recordings that appear whole, however long they take to be made.

use std::path::Path;

use tabletop_storage::{LockedFolder, Storage, WriterLock, is_taken, parent_of};

use crate::{
    error::RecorderError,
    files::{
        folder::Folder,
        new_recording::{occupant, take_the_place},
    },
    recording::report::MovedAside,
};

/// The folder of the recording, within the hidden one.
const CONTENT: &str = "content";

/// Lets a recording be made in a folder under a hidden name, and gives it its own when that has succeeded; an earlier recording is moved
/// aside then, and returned. Killed before, nothing has changed.
///
/// # Errors
/// It could not be made; something else has the name, or another program makes a recording of it; or something cannot be written.
pub fn whole_recording<T, E: From<RecorderError>>(
    path: &Path,
    storage: &Storage,
    make: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<(T, Option<MovedAside>), E> {
    let parent = parent_of(path);
    let create = |error| RecorderError::create(path)(error);
    storage.create_folders(parent).map_err(create)?;
    let _alone = WriterLock::of_place(path, storage).map_err(create)?;
    let folder = Folder::at(path, storage);
    occupant(&folder)?;
    let draft = LockedFolder::beside(path, storage).map_err(create)?;
    let content = Folder::at(&draft.path().join(CONTENT), storage);
    let made = make(content.path()).and_then(|made| {
        // Without room for the task, nothing is recorded.
        if !is_taken(content.path()) {
            return Ok((made, None));
        }
        let placed = take_the_place(&folder, &content, &occupant(&folder)?, |_| Ok(()))?;
        storage.sync_folder(parent).map_err(create)?;
        let moved_aside = placed.moved_aside.map(|to| MovedAside {
            from: path.to_owned(),
            to,
        });
        Ok((made, moved_aside))
    });
    let removed = draft.remove();
    let made = made?;
    removed.map_err(create)?;
    Ok(made)
}
