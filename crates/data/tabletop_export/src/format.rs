//! Formats, and the export of recordings to them.

use std::path::PathBuf;

use tabletop_sim::run_episodes;
use tabletop_training::{EpisodeSelection, TrainingEpisode};

use crate::error::ExportError;

/// A dataset that is being written.
pub trait DatasetFormat {
    /// An episode, prepared to be written.
    type Prepared: Send;

    /// Prepares an episode. Called on several threads at a time, so the long work belongs here.
    ///
    /// # Errors
    /// The episode does not fit the format.
    fn prepare(episode: TrainingEpisode) -> Result<Self::Prepared, ExportError>;

    /// Writes an episode behind the ones before. Returns its number of frames.
    ///
    /// # Errors
    /// It does not fit the episodes before, or cannot be written.
    fn write(&mut self, episode: Self::Prepared) -> Result<usize, ExportError>;

    /// Makes everything written part of the dataset.
    ///
    /// # Errors
    /// A file cannot be written; the dataset is then as it was before, or can be repaired.
    fn finish(self) -> Result<(), ExportError>;
}

/// The numbers of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExportSummary {
    /// Number of episodes written.
    pub episodes: usize,
    /// Number of their frames.
    pub frames: usize,
}

/// Exports recordings in this order, on `jobs` threads. `tell` hears of every episode that is written. The result is the same for any number
/// of threads.
///
/// # Errors
/// A recording cannot be read or does not fit, or the dataset cannot be written. Nothing of this export is then part of the dataset.
pub fn export<F: DatasetFormat>(
    recordings: &[PathBuf],
    selection: &EpisodeSelection,
    mut format: F,
    jobs: usize,
    mut tell: impl FnMut(ExportSummary),
) -> Result<ExportSummary, ExportError> {
    let mut summary = ExportSummary::default();
    let prepare = |number: u64| {
        let recording = &recordings[number as usize];
        F::prepare(TrainingEpisode::read(recording, selection)?)
    };
    run_episodes(0..recordings.len() as u64, jobs, prepare, |_, prepared| {
        summary.frames += format.write(prepared)?;
        summary.episodes += 1;
        tell(summary);
        Ok(())
    })?;
    format.finish()?;
    Ok(summary)
}
