//! Undo and redo of an episode.

use bevy::prelude::warn;
use tabletop_core::{HistoryFact, SimFact, Timeline};

use crate::{
    error::RecorderError,
    files::session::command_line,
    recording::{
        episode::Episode,
        progress::{RecordingProgress, UndoneSegment},
    },
};

/// A change of the clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HistoryTurn {
    Undo,
    Redo,
}

impl HistoryTurn {
    pub fn of(fact: &SimFact) -> Option<Self> {
        if let SimFact::History(HistoryFact::Undone { .. }) = fact {
            Some(Self::Undo)
        } else if let SimFact::History(HistoryFact::Redone { .. }) = fact {
            Some(Self::Redo)
        } else {
            None
        }
    }
}

impl Episode {
    pub(super) fn progress(&self) -> RecordingProgress {
        RecordingProgress {
            files: self.files.lengths(),
            objects: self.objects.clone(),
            sight: self.sight.clone(),
            last_joints: self.last_joints.clone(),
            is_paused: self.is_paused,
            marks: self.marks.clone(),
        }
    }

    /// Goes back to the moment before the present segment began, and puts its files away.
    pub(super) fn undo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
        let Some(start) = self.undoable.pop() else {
            warn!("the world was restored to a moment before the recording; the recording goes on");
            return Ok(());
        };
        let end = self.progress();
        let mut then = Vec::new();
        for command in &start.released {
            then.extend(command_line(command)?);
        }
        then.extend(&start.before.marks);
        self.files.put_away(start.before.files, &then)?;
        self.resume(start.before.clone());
        let timeline = start.timeline.cut(timeline);
        self.redoable.push(UndoneSegment {
            start,
            end,
            timeline,
        });
        Ok(())
    }

    /// Brings back the segment that was undone last, in the place of what was recorded since.
    pub(super) fn redo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
        let Some(undone) = self.redoable.pop() else {
            warn!(
                "the world was restored to a moment outside the recording; the recording goes on"
            );
            return Ok(());
        };
        let UndoneSegment { start, end, .. } = undone;
        start.timeline.cut(timeline);
        undone.timeline.append_to(timeline);
        let first_frame = self.clock.frame(start.tick);
        self.files
            .bring_back(start.before.files, first_frame, end.files)?;
        self.resume(end);
        self.undoable.push(start);
        Ok(())
    }

    pub(super) fn resume(&mut self, progress: RecordingProgress) {
        self.objects = progress.objects;
        self.sight = progress.sight;
        self.last_joints = progress.last_joints;
        self.is_paused = progress.is_paused;
        self.marks = progress.marks;
    }
}
