//! The recordings in a folder, and what the user wants to be done with them.

use std::path::PathBuf;

use bevy::prelude::*;

/// The recordings in a folder, as far as they have been read.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Shelf {
    /// The folder.
    pub folder: PathBuf,
    /// Its recordings, the last one that was made first.
    pub recordings: Vec<ShelvedRecording>,
    /// The reason why there are none.
    pub problem: Option<String>,
    /// The work that is being done on some of them.
    pub errand: Option<RunningErrand>,
}

/// A recording on a [`Shelf`].
#[derive(Clone, Debug, PartialEq)]
pub struct ShelvedRecording {
    /// Its folder.
    pub folder: PathBuf,
    /// The name of its folder.
    pub name: String,
    /// What is known of it; `None` while it is being read, the reason if it cannot be.
    pub digest: Option<Result<RecordingDigest, String>>,
}

/// What is told of a recording that is not open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordingDigest {
    /// Its length, in ticks.
    pub ticks: u64,
    /// The number of its segments.
    pub segments: usize,
    /// True if it was finished; else it was cut off.
    pub is_finished: bool,
    /// The sentences of its task.
    pub sentences: Vec<String>,
    /// The notes on it.
    pub notes: String,
    /// Its last picture.
    pub picture: Option<PathBuf>,
}

/// A wish of the user about recordings.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum ShelfOrder {
    /// Read the recordings in this folder anew.
    Look(PathBuf),
    /// Give the recording in this folder another name, beside it.
    Rename(PathBuf, String),
    /// Move the recording in this folder to the [trash](TRASH) beside it.
    Discard(PathBuf),
    /// Replace the notes on the recording in this folder.
    Note(PathBuf, String),
    /// Begin a piece of work.
    Begin(Errand),
    /// End the work that is being done. What it has made whole stays.
    Cancel,
}

/// The name of the folder beside recordings to which those that are discarded are moved.
pub const TRASH: &str = "trash";

/// A piece of work that the program does beside the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Errand {
    /// Write recordings as a dataset.
    Export {
        /// Their folders.
        recordings: Vec<PathBuf>,
        /// The name of the format.
        format: String,
        /// The folder of the dataset.
        out: PathBuf,
    },
    /// Make variations of a recording.
    Multiply {
        /// Its folder.
        recording: PathBuf,
        /// The number of variations.
        count: u32,
        /// The folder in which they are made.
        out: PathBuf,
    },
    /// Let the robot imitate a recording, and record that.
    Imitate {
        /// Its folder.
        recording: PathBuf,
        /// The folder of the robot's recording.
        out: PathBuf,
    },
}

/// A piece of work that is being done.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningErrand {
    /// The work.
    pub errand: Errand,
    /// The part that is done, of how many; `None` if that is not known.
    pub progress: Option<(u64, u64)>,
}

impl Errand {
    /// The folder in which its results are.
    pub fn out(&self) -> &PathBuf {
        match self {
            Self::Export { out, .. } | Self::Multiply { out, .. } | Self::Imitate { out, .. } => {
                out
            }
        }
    }

    /// What is being done, as a sentence without its end.
    pub fn sentence(&self) -> String {
        let out = self.out().display();
        match self {
            Self::Export { format, .. } => format!("exporting to {format} in {out}"),
            Self::Multiply { count, .. } => format!("making {count} variations in {out}"),
            Self::Imitate { .. } => format!("the robot imitates, recorded in {out}"),
        }
    }
}
