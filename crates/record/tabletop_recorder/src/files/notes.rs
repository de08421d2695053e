//! What a person has written about a recording.

use std::{
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use tabletop_storage::{Storage, Symlinks, read_regular_text};

use crate::error::RecorderError;

/// The name of the notes' file in a recording's folder. A replay does not make it.
pub const NOTES: &str = "notes.txt";

/// The most bytes of notes that are read.
const MOST_BYTES: u64 = 1 << 16;

/// The notes on the recording in a folder; empty if there are none.
///
/// # Errors
/// The file is a link, is longer than 64 KiB, or cannot be read.
pub fn read_notes(folder: &Path) -> Result<String, RecorderError> {
    let path = folder.join(NOTES);
    match read_regular_text(&path, MOST_BYTES, Symlinks::Refused) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(String::new()),
        read => read.map_err(RecorderError::read(&path)),
    }
}

/// Replaces the notes on the recording in a folder; empty ones have no file.
///
/// # Errors
/// They are longer than 64 KiB, or the file cannot be written. Then the earlier notes stay.
pub fn write_notes(folder: &Path, notes: &str) -> Result<(), RecorderError> {
    let path: PathBuf = folder.join(NOTES);
    let storage = Storage::default();
    let written = match notes {
        "" => match storage.remove_file(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
            removed => removed,
        },
        notes if notes.len() as u64 > MOST_BYTES => Err(io::Error::new(
            ErrorKind::InvalidInput,
            format!("notes of more than {MOST_BYTES} bytes are not kept"),
        )),
        notes => storage.replace(&path, notes.as_bytes()),
    };
    written.map_err(RecorderError::write(&path))
}

#[cfg(test)]
mod tests {
    use std::{env, fs, process};

    use super::*;

    #[test]
    fn notes_read_back_and_empty_ones_leave_no_file() {
        let folder = env::temp_dir().join(format!("tabletop-notes-{}", process::id()));
        fs::create_dir_all(&folder).unwrap();
        assert_eq!(read_notes(&folder).unwrap(), "");
        write_notes(&folder, "the second one is crooked\n").unwrap();
        assert_eq!(read_notes(&folder).unwrap(), "the second one is crooked\n");
        let error = write_notes(&folder, &"x".repeat(70_000)).unwrap_err();
        assert!(error.to_string().contains("65536 bytes"), "{error}");
        assert_eq!(read_notes(&folder).unwrap(), "the second one is crooked\n");
        for _ in 0..2 {
            write_notes(&folder, "").unwrap();
            assert!(!folder.join(NOTES).exists());
        }
        fs::remove_dir_all(folder).unwrap();
    }
}
