//! Making up for what a killed program has left undone.

use std::path::{Path, PathBuf};

use tabletop_export::{LeRobot, LeRobotRepair};
use tabletop_recorder::RecordingReader;
use tabletop_storage::{Storage, is_taken};

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder},
};

/// What a repair has done and found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Repair {
    /// That of a LeRobot dataset.
    pub lerobot: LeRobotRepair,
    /// Number of episodes afterwards.
    pub episodes: usize,
    /// Recordings that were cut off: they are read as far as they go.
    pub cut_off: Vec<PathBuf>,
}

/// Ends or takes back an export to a LeRobot dataset that was cut off, and counts its episodes and statistics anew if they are not those of its
/// tables; of recordings, finishes an undo that was.
///
/// # Errors
/// Another program writes there and the storage is not to wait for it; it is no dataset, what is there afterwards does not fit together, or something cannot be written.
pub fn repair(path: &Path, storage: &Storage) -> Result<Repair, DatasetError> {
    if !is_taken(&path.join("meta")) {
        let dataset = DatasetFolder::open(path)?;
        let mut repair = Repair {
            episodes: dataset.episodes(),
            ..Repair::default()
        };
        if let DatasetContent::Recordings(recordings) = dataset.content {
            for folder in recordings {
                if RecordingReader::open(&folder)?.cut_off_at().is_some() {
                    repair.cut_off.push(folder);
                }
            }
        }
        return Ok(repair);
    }
    let lerobot = LeRobot::repair(path, storage)?;
    Ok(Repair {
        lerobot,
        episodes: lerobot.episodes,
        cut_off: Vec::new(),
    })
}
