//! The content of the Timeline, and the user's wishes.

use std::path::PathBuf;

use tabletop_core::{
    History, Playback, ShownStep, ShownTask, SimTick, Timeline, TimelineSegment, TimelineStage,
};
use tabletop_user::{EditOrder, Editing, Imitating, Keymap, Pace, TaskOrder, TaughtProgram};

use super::axis::seconds;

/// The content of the panel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Model<'a> {
    pub timeline: &'a Timeline,
    pub playback: Playback,
    /// The tick whose end the world shows.
    pub shown: SimTick,
    pub is_paused: bool,
    pub pace: Pace,
    pub history: History,
    pub keymap: &'a Keymap,
    /// The task of the recording.
    pub task: &'a ShownTask,
    /// The program that the last demonstrations mean.
    pub taught: &'a TaughtProgram,
    pub imitating: &'a Imitating,
    pub editing: &'a Editing,
}

/// A wish of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    Play,
    Pause,
    /// Simulate one tick.
    Step,
    /// Show the end of this tick, and play on if it plays.
    GoTo(SimTick),
    /// Show the end of this tick, and stand still.
    StopAt(SimTick),
    SetPace(Pace),
    Loop(bool),
    /// Undo this number of segments.
    Undo(usize),
    Redo,
    Open(PathBuf),
    SaveVideo,
    Close,
    Task(TaskOrder),
    Edit(EditOrder),
}

impl Model<'_> {
    pub fn is_open(&self) -> bool {
        self.timeline.stage == TimelineStage::Open
    }

    /// The steps that this recording shows; those of another one are not along its time.
    pub fn shown_steps(&self) -> &[ShownStep] {
        let is_there = match self.timeline.stage {
            TimelineStage::Finished | TimelineStage::Open => true,
            TimelineStage::Absent | TimelineStage::Running => false,
        };
        match is_there && self.task.folder == self.timeline.folder {
            true => &self.task.steps,
            false => &[],
        }
    }

    /// The tick of the playhead.
    pub fn playhead(&self) -> SimTick {
        let Timeline { start, end, .. } = *self.timeline;
        self.shown.clamp(start, end.max(start))
    }

    /// A moment in seconds from the beginning.
    pub fn time(&self, tick: SimTick) -> String {
        seconds(tick.0.saturating_sub(self.timeline.start.0))
    }

    /// The moment that it has come to, or is going to.
    pub fn progress(&self) -> String {
        match self.playback.goal {
            Some(goal) => format!("going to {} …", self.time(goal)),
            None => format!(
                "{} of {}",
                self.time(self.playhead()),
                self.time(self.timeline.end)
            ),
        }
    }

    /// The sentence of a segment.
    pub fn sentence(&self, number: usize) -> String {
        let act = self
            .segment(number)
            .and_then(|segment| segment.act.as_ref());
        let act = act.map_or_else(|| "Beginning".into(), ToString::to_string);
        format!("Segment {number}: {act}")
    }

    pub fn segment(&self, number: usize) -> Option<&TimelineSegment> {
        self.timeline.segments.get(number)
    }
}

/// A moment that the user points out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moment {
    /// The mouse drags over it.
    Dragged(SimTick),
    /// It was clicked, or the mouse let go there.
    Chosen(SimTick),
}
