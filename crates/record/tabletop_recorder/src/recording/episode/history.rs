//! Undo and redo of an episode.

use bevy::prelude::warn;
use tabletop_core::{CommandSystems, HistoryFact, Paused, SimTick, Timeline};

use crate::{
    error::RecorderError,
    files::session::command_line,
    recording::{
        episode::Episode,
        progress::{RecordingProgress, UndoneSegment},
    },
};

impl Episode {
    /// Follows undo and redo to this tick, in which the simulation is paused or not. A pause is not undone.
    pub(crate) fn follow(
        &mut self,
        history: &[HistoryFact],
        tick: SimTick,
        paused: Paused,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        for fact in history {
            match fact {
                HistoryFact::Undone { .. } => self.undo(timeline)?,
                HistoryFact::Redone { .. } => self.redo(timeline)?,
                HistoryFact::SegmentBegun { .. } | HistoryFact::Kept { .. } => {}
            }
        }
        // A tick has several frames while it is paused, and after undo; its marks stay behind the commands of all of them.
        if tick != self.tick {
            self.marks.clear();
        }
        self.tick = tick;
        self.note_pause(paused)
    }

    /// Logs a pause that no command has begun or ended.
    pub(crate) fn note_pause(&mut self, paused: Paused) -> Result<(), RecorderError> {
        match self.is_paused == paused.0 {
            true => Ok(()),
            false => self.log_pause(paused.0),
        }
    }

    pub(super) fn progress(&self) -> RecordingProgress {
        RecordingProgress {
            files: self.files.lengths(),
            objects: self.objects.clone(),
            sight: self.sight.clone(),
            last_joints: self.last_joints.clone(),
            is_paused: self.is_paused,
            tick: self.tick,
            last: self.last,
            marks: self.marks.clone(),
        }
    }

    /// Goes back to the moment before the present segment began, and puts its files away.
    fn undo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
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
        if !start.released.is_empty() {
            self.last = Some((self.tick, CommandSystems::Hands));
        }
        let timeline = start.timeline.cut(timeline);
        self.redoable.push(UndoneSegment {
            start,
            end,
            timeline,
        });
        Ok(())
    }

    /// Brings back the last undone segment, in the place of later lines.
    fn redo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
        let Some(undone) = self.redoable.pop() else {
            warn!(
                "the world was restored to a moment outside the recording; the recording goes on"
            );
            return Ok(());
        };
        let UndoneSegment { start, end, .. } = undone;
        start.timeline.cut(timeline);
        undone.timeline.append_to(timeline);
        let first_frame = self.clock.frame(start.before.tick);
        self.files
            .bring_back(start.before.files, first_frame, end.files)?;
        self.resume(end);
        self.undoable.push(start);
        Ok(())
    }

    fn resume(&mut self, progress: RecordingProgress) {
        self.objects = progress.objects;
        self.sight = progress.sight;
        self.last_joints = progress.last_joints;
        self.is_paused = progress.is_paused;
        self.tick = progress.tick;
        self.last = progress.last;
        self.marks = progress.marks;
    }
}
