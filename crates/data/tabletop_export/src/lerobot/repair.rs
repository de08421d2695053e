//! Repair of a dataset.

use std::path::Path;

use tabletop_storage::{InnerPath, Storage, WriterLock};

use super::{
    commit::{Commit, PendingCommit},
    episode_table,
    info::Info,
    reader::FrameTables,
    stats, task_table,
};
use crate::error::ExportError;

/// The repair of a dataset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeRobotRepair {
    /// What an export that was cut off had left.
    pub export: Option<PendingCommit>,
    /// Number of its episodes.
    pub episodes: usize,
    /// True if the totals or the statistics were not those of the tables. Now they are.
    pub is_recounted: bool,
}

impl LeRobotRepair {
    /// Repairs a dataset: makes up for an export that was cut off, or removes what it left; then lets its totals and statistics be those of its
    /// tables.
    pub(super) fn of(folder: &Path, storage: &Storage) -> Result<Self, ExportError> {
        let _alone = WriterLock::of_folder(folder, storage).map_err(ExportError::io(folder))?;
        let export = Commit::pending(folder, storage)?;
        let mut commit = Commit::begin(folder, storage)?;
        let Some(mut info) = Info::read(folder)? else {
            return Ok(Self {
                export,
                ..Self::default()
            });
        };
        let tables = FrameTables::count(folder)?;
        let totals = [
            tables.episodes,
            tables.frames,
            task_table::read(folder)?.len(),
        ];
        let are_totals_true = info.contradiction(totals).is_none();
        [info.total_episodes, info.total_frames, info.total_tasks] = totals;
        let are_stats_true = stats::read(folder, &info)
            .is_ok_and(|known| stats::count_frames(&known, info.total_frames));
        let is_recounted = !(are_totals_true && are_stats_true);
        if !are_stats_true {
            let counted = episode_table::read_stats(folder, &info)?;
            let path = InnerPath::fixed(stats::PATH);
            commit.add(&path, &stats::write(&counted))?;
        }
        if is_recounted {
            let path = InnerPath::fixed(Info::PATH);
            commit.add(&path, &info.write())?;
            commit.end()?;
        }
        Ok(Self {
            export,
            episodes: tables.episodes,
            is_recounted,
        })
    }
}
