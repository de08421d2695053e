//! New folders, which appear whole.

use std::{io, path::Path};

use tabletop_storage::{LockedFolder, Storage, WriterLock, is_taken, parent_of};

use crate::error::DatasetError;

/// The folder that is filled, within the hidden one.
const CONTENT: &str = "content";

/// Makes a folder, or fills an empty one, with what `fill` writes to the path that it gets; the folder is there with all of it, on the disk, or not
/// at all.
pub(crate) fn make_folder<T>(
    path: &Path,
    storage: &Storage,
    fill: impl FnOnce(&Path) -> Result<T, DatasetError>,
) -> Result<T, DatasetError> {
    let parent = parent_of(path);
    let io = |error| DatasetError::io(path)(error);
    storage.create_folders(parent).map_err(io)?;
    let _alone = WriterLock::of_place(path, storage).map_err(io)?;
    let is_empty = is_empty_folder(path, storage).map_err(io)?;
    if is_taken(path) && !is_empty {
        let problem = "something is there already; name a new folder";
        return Err(DatasetError::unfit(path, problem));
    }
    let draft = LockedFolder::beside(path, storage).map_err(io)?;
    let content = draft.path().join(CONTENT);
    let filled = storage
        .create_folder(&content)
        .map_err(io)
        .and_then(|()| fill(&content))
        .and_then(|filled| {
            storage.sync_tree(&content).map_err(io)?;
            let placed = match is_empty {
                true => storage.rename_onto_empty(&content, path),
                false => storage.rename(&content, path),
            };
            placed
                .and_then(|()| storage.sync_folder(parent))
                .map_err(io)?;
            Ok(filled)
        });
    let removed = draft.remove();
    let filled = filled?;
    removed.map_err(io)?;
    Ok(filled)
}

fn is_empty_folder(path: &Path, storage: &Storage) -> io::Result<bool> {
    match path.is_dir() && !path.is_symlink() {
        true => Ok(storage.entries(path)?.is_empty()),
        false => Ok(false),
    }
}
