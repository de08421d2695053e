//! Changes of several files at once, of which all happen or none.
//!
//! The intent is written before the files are touched, and gone when all of it is done. A program that finds one in a recording that nobody
//! is making carries it out: every step can be taken twice.

use std::path::Path;

use serde::{Deserialize, Serialize};
use tabletop_storage::is_taken;

use crate::{
    error::RecorderError,
    files::{
        folder::Folder,
        json::from_json,
        limits::{MOST_ROW_BYTES, MOST_SESSION_BYTES},
    },
};

/// The longest that is read: it holds a few lines of commands.
const MOST_BYTES: u64 = 1 << 20;

/// The lengths of a recording's files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Lengths {
    pub(crate) segment: u32,
    pub(crate) text: u64,
    pub(crate) session: u64,
    pub(crate) states: u64,
    pub(crate) joints: u64,
}

/// A change that is about to be made to the files of a recording.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Intent {
    /// A segment is put away; the ends of the logs that belong to it are in its folder already.
    PutAway {
        segment: u32,
        before: Lengths,
        /// Lines with which the session log goes on.
        then: String,
    },
    /// A segment that was put away is brought back, in the place of everything since, of which this was the first frame.
    BringBack {
        segment: u32,
        before: Lengths,
        first_frame: u64,
    },
    /// The recording ends with a last frame. It is taken back unless the session log has come to an end.
    Finish {
        before: Lengths,
        /// The length of the session log then.
        session: u64,
        /// From which frame on pictures are its own.
        first_frame: u64,
    },
}

impl Intent {
    /// Writes it down: from now on, it will be done.
    pub(crate) fn declare(&self, folder: &Folder) -> Result<(), RecorderError> {
        let path = folder.intent();
        let fault = RecorderError::write(&path);
        match serde_json::to_vec(self) {
            Ok(bytes) => folder.storage().write_whole(&path, &bytes, false),
            Err(error) => Err(error.into()),
        }
        .map_err(fault)
    }

    /// Does it, and forgets it.
    pub(crate) fn fulfil(&self, folder: &Folder) -> Result<(), RecorderError> {
        match self {
            Self::PutAway {
                segment,
                before,
                then,
            } => {
                let away = folder.require_undone_segment(*segment)?;
                for (log, len, lines) in [
                    (folder.session(), before.session, then.as_bytes()),
                    (folder.states(), before.states, &[]),
                    (folder.joints(), before.joints, &[]),
                ] {
                    replace_end(folder, &log, len, lines)?;
                }
                folder.move_segment(*segment, &away)?;
            }
            Self::BringBack {
                segment,
                before,
                first_frame,
            } => {
                let away = folder.require_undone_segment(*segment)?;
                folder.remove_pictures(before.segment, *first_frame)?;
                replace_end(folder, &folder.text(before.segment), before.text, &[])?;
                for (log, len, end, most) in [
                    (
                        folder.session(),
                        before.session,
                        away.session(),
                        MOST_SESSION_BYTES,
                    ),
                    (
                        folder.states(),
                        before.states,
                        away.states(),
                        MOST_ROW_BYTES,
                    ),
                    (
                        folder.joints(),
                        before.joints,
                        away.joints(),
                        MOST_ROW_BYTES,
                    ),
                ] {
                    let lines = folder.storage().read(&end, most);
                    let lines = lines.map_err(RecorderError::read(&end))?;
                    replace_end(folder, &log, len, &lines)?;
                }
                away.move_segment(*segment, folder)?;
            }
            Self::Finish {
                before,
                session,
                first_frame,
            } => {
                let path = folder.session();
                let file = folder.storage().open_to_read(&path);
                let len = file.and_then(|file| file.byte_count());
                if len.map_err(RecorderError::read(&path))? < *session {
                    replace_end(folder, &folder.text(before.segment), before.text, &[])?;
                    replace_end(folder, &path, before.session, &[])?;
                    folder.remove_pictures(before.segment, *first_frame)?;
                }
            }
        }
        self.forget(folder)
    }

    /// Forgets it: it is done.
    pub(crate) fn forget(&self, folder: &Folder) -> Result<(), RecorderError> {
        let path = folder.intent();
        let removed = folder.storage().remove_file(&path);
        removed.map_err(RecorderError::write(&path))
    }
}

/// Finishes the interrupted change of a killed program.
pub(crate) fn finish_interrupted(folder: &Folder) -> Result<(), RecorderError> {
    let path = folder.intent();
    if !is_taken(&path) {
        return Ok(());
    }
    let interrupted = |source| RecorderError::Interrupted {
        folder: folder.path().to_owned(),
        source: Box::new(source),
    };
    let session = folder.session();
    let lock = folder.storage().open_to_read(&session);
    let lock = lock.map_err(|error| interrupted(RecorderError::read(&session)(error)))?;
    // Only the maker or another reader of the recording does it now. A process that is being started has the locks of the program
    // that starts it for a moment, and does nothing.
    let is_ours = lock.lock_unless(|| !is_taken(&path));
    if !is_taken(&path) {
        return Ok(());
    }
    if !is_ours {
        return Err(RecorderError::BeingChanged {
            folder: folder.path().to_owned(),
        });
    }
    let intent = folder.storage().read(&path, MOST_BYTES).and_then(|bytes| {
        let intent: Intent = from_json(&bytes)?;
        Ok(intent)
    });
    intent
        .map_err(RecorderError::read(&path))
        .and_then(|intent| intent.fulfil(folder))
        .map_err(interrupted)
}

/// Keeps the first `len` bytes of a log, and has these lines follow.
fn replace_end(folder: &Folder, path: &Path, len: u64, lines: &[u8]) -> Result<(), RecorderError> {
    let replace = || {
        let mut file = folder.storage().open(path)?;
        if file.byte_count()? < len {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        file.cut(len)?;
        match lines.is_empty() {
            true => Ok(()),
            false => file.append(lines),
        }
    };
    replace().map_err(RecorderError::write(path))
}
