//! Making up for what a killed program has left undone.

use std::path::{Path, PathBuf};

use tabletop_export::{LeRobot, LeRobotReader, PendingCommit};
use tabletop_recorder::RecordingReader;
use tabletop_storage::is_taken;

use crate::{
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder},
};

/// What a repair has done and found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Repair {
    /// What an export that was cut off had left, which is now ended or taken back.
    pub export: Option<PendingCommit>,
    /// Number of episodes afterwards.
    pub episodes: usize,
    /// Recordings that were cut off: they are read as far as they go.
    pub cut_off: Vec<PathBuf>,
}

/// Ends or takes back an export to a LeRobot dataset that was cut off; of recordings, finishes an undo that was.
///
/// # Errors
/// It is no dataset, what is there afterwards does not fit together, or something cannot be written.
pub fn repair(path: &Path) -> Result<Repair, DatasetError> {
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
    let export = LeRobot::pending(path)?;
    if export.is_some() {
        drop(LeRobot::open(path.to_owned())?);
    }
    if !is_taken(&path.join("meta/info.json")) {
        return Ok(Repair {
            export,
            ..Repair::default()
        });
    }
    let reader = LeRobotReader::open(path)?;
    Ok(Repair {
        export,
        episodes: reader.episodes(),
        cut_off: Vec::new(),
    })
}
