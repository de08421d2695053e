//! Folders of numbered recordings that one command makes.

use std::{
    io,
    path::{Path, PathBuf},
};

use serde_json::Value;
use tabletop_recorder::{RecorderError, RecordingReader, SessionHeader};
use tabletop_storage::{
    InnerPath, LockedFolder, Storage, Symlinks, WriterLock, is_taken, read_regular_text,
};

/// The most bytes of it that are read.
const MOST_BYTES: u64 = 1 << 20;

/// Prefix of the hidden folder in which recordings are made.
const WORKSHOP: &str = ".making-";

/// A folder of recordings, each in a folder of its number. Nobody else makes recordings there as long as this exists.
#[derive(Debug)]
pub struct Collection {
    folder: PathBuf,
    storage: Storage,
    /// Where recordings are made. One that is whole is moved out of it.
    workshop: LockedFolder,
    _lock: WriterLock,
}

/// The error of a folder that takes no recordings.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum CollectionError {
    #[error("{}: the recordings there were made with other options or of something else; name a new folder", .0.display())]
    OtherManifest(PathBuf),
    #[error("{}: it holds something else; name a new folder", .0.display())]
    SomethingElse(PathBuf),
    #[error("{}: it is no whole recording of this collection; move it away, and it is made again", .0.display())]
    NoMember(PathBuf),
    #[error("{}: {source}", .path.display())]
    Io { path: PathBuf, source: io::Error },
}

impl Collection {
    /// Opens a folder, which is made if it does not exist, for recordings with this manifest: what they are made of, and the options, so that
    /// others are not mixed with them. It is in the file of this name.
    ///
    /// # Errors
    /// It holds something else, or recordings of another manifest; or another program makes recordings there and the storage is not to wait for it.
    pub fn open(
        folder: &Path,
        name: &'static str,
        manifest: &Value,
        storage: &Storage,
    ) -> Result<Self, CollectionError> {
        storage
            .create_folders(folder)
            .map_err(CollectionError::io(folder))?;
        let path = InnerPath::fixed(name).below(folder);
        let lock = WriterLock::of_folder(folder, storage).map_err(CollectionError::io(folder))?;
        if !is_taken(&path) {
            begin(folder, &path, manifest, storage)?;
        }
        let text = read_regular_text(&path, MOST_BYTES, Symlinks::Refused);
        let known = serde_json::from_str(&text.map_err(CollectionError::io(&path))?);
        if known.ok().as_ref() != Some(manifest) {
            return Err(CollectionError::OtherManifest(path));
        }
        let workshop =
            LockedFolder::create(folder, WORKSHOP, storage).map_err(CollectionError::io(folder))?;
        Ok(Self {
            folder: folder.to_owned(),
            storage: storage.clone(),
            workshop,
            _lock: lock,
        })
    }

    /// True if the recording of a number is there, whole, and the right one.
    ///
    /// # Errors
    /// Something else is in its place.
    pub fn holds(
        &self,
        number: u64,
        is_right: impl FnOnce(&SessionHeader) -> bool,
    ) -> Result<bool, CollectionError> {
        let path = self.place_of(number);
        if !is_taken(&path) || (!path.is_symlink() && self.is_empty(&path)) {
            return Ok(false);
        }
        match !path.is_symlink() && is_member(&path, is_right).unwrap_or(false) {
            true => Ok(true),
            false => Err(CollectionError::NoMember(path)),
        }
    }

    /// The folder in which the recording of a number is to be made.
    pub fn part(&self, number: u64) -> PathBuf {
        name(number).below(self.workshop.path())
    }

    /// Puts the recording that was made into the collection, and onto the disk.
    ///
    /// # Errors
    /// It cannot be moved there.
    pub fn keep(&self, number: u64) -> Result<(), CollectionError> {
        let (part, place) = (self.part(number), self.place_of(number));
        let moved = match is_taken(&place) {
            true => self.storage.rename_onto_empty(&part, &place),
            false => self.storage.rename(&part, &place),
        };
        moved
            .and_then(|()| self.storage.sync_folder(&self.folder))
            .map_err(CollectionError::io(&place))
    }

    /// Ends the work on it.
    ///
    /// # Errors
    /// The hidden folder cannot be removed.
    pub fn close(self) -> Result<(), CollectionError> {
        let closed = self.workshop.remove();
        closed.map_err(CollectionError::io(&self.folder))
    }

    /// The folder of the recording of a number in a collection in a folder.
    pub fn place_in(folder: &Path, number: u64) -> PathBuf {
        name(number).below(folder)
    }

    fn place_of(&self, number: u64) -> PathBuf {
        Self::place_in(&self.folder, number)
    }

    fn is_empty(&self, folder: &Path) -> bool {
        let entries = self.storage.entries(folder);
        entries.is_ok_and(|entries| entries.is_empty())
    }
}

impl CollectionError {
    fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }
}

/// Writes the manifest into a folder that must be empty.
fn begin(
    folder: &Path,
    path: &Path,
    manifest: &Value,
    storage: &Storage,
) -> Result<(), CollectionError> {
    let entries = storage.entries(folder);
    let mut entries = entries.map_err(CollectionError::io(folder))?.into_iter();
    // A killed program may have left hidden files.
    if !entries.all(|entry| is_hidden(&entry)) {
        return Err(CollectionError::SomethingElse(folder.to_owned()));
    }
    let text = format!("{manifest:#}\n");
    let written = storage.write_new(path, text.as_bytes());
    written.map_err(CollectionError::io(path))
}

fn name(number: u64) -> InnerPath {
    InnerPath::padded("", 4, number, "")
}

fn is_hidden(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().starts_with('.')
}

/// True if a recording is whole, and the right one.
fn is_member(
    folder: &Path,
    is_right: impl FnOnce(&SessionHeader) -> bool,
) -> Result<bool, RecorderError> {
    let recording = RecordingReader::open(folder)?;
    Ok(recording.cut_off_at().is_none() && is_right(recording.header()))
}
