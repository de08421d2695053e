//! A recording, read for a page.

use std::path::{Path, PathBuf};

use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_recorder::{RecordedSegment, RecordingReader};
use tabletop_task::{Demonstration, Requirements, Task};
use tabletop_training::{ActionKind, EpisodeError, EpisodeSelection, StateKind, TrainingEpisode};

/// A recording, read for a page.
#[derive(Debug)]
pub struct Chapter {
    /// Its folder.
    pub folder: PathBuf,
    pub(crate) episode: TrainingEpisode,
    pub(crate) task: Task,
    pub(crate) requirements: Requirements,
    pub(crate) segments: Vec<RecordedSegment>,
    pub(crate) program: String,
}

impl Chapter {
    /// Reads a recording.
    ///
    /// # Errors
    /// A file cannot be read, or the recording has no pictures.
    pub fn read(folder: &Path) -> Result<Self, EpisodeError> {
        let recording = RecordingReader::open(folder)?;
        let shown = Demonstration::of(&recording)?;
        let mut task = Task::of(&shown);
        let requirements = Requirements::read_for(&task, folder)?;
        task.phrase(&requirements);
        let selection = EpisodeSelection {
            state: Some(StateKind::Robot),
            action: Some(ActionKind::Hands),
            ..EpisodeSelection::default()
        };
        Ok(Self {
            folder: folder.to_owned(),
            episode: TrainingEpisode::read(folder, &selection)?,
            segments: recording.segments()?,
            program: recording.header().program.clone(),
            task,
            requirements,
        })
    }

    /// The name of its folder.
    pub(crate) fn name(&self) -> String {
        let name = self.folder.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The time from its beginning to a tick, in s.
    pub(crate) fn seconds(&self, tick: SimTick) -> f64 {
        let first = self.episode.ticks.first().map_or(0, |tick| tick.0);
        tick.0.saturating_sub(first) as f64 / f64::from(TICKS_PER_SECOND)
    }

    /// Its length, in s.
    pub(crate) fn length(&self) -> f64 {
        self.episode
            .ticks
            .last()
            .map_or(0.0, |last| self.seconds(*last))
    }

    /// The steps and operations with the times at which they are done, in their order.
    pub(crate) fn deeds(&self) -> Vec<(f64, f64, String)> {
        let steps = self.task.steps.iter().map(|step| {
            let [from, to] = [step.grasp, step.release].map(|tick| self.seconds(tick));
            (from, to, step.sentence.clone())
        });
        let operations = self.task.operations.iter().map(|done| {
            let at = self.seconds(done.tick);
            (at, at, done.sentence())
        });
        let mut deeds: Vec<_> = steps.chain(operations).collect();
        deeds.sort_by(|one, other| one.0.total_cmp(&other.0));
        deeds
    }

    /// True if a number of the robot's joints changes.
    pub(crate) fn has_robot(&self) -> bool {
        let mut frames = self.episode.state.frames();
        let first = frames.next();
        frames.any(|frame| Some(frame) != first)
    }
}
