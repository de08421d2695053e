//! The progress of a recording, for undo and redo.

use tabletop_core::{CommandSystems, JointState, SimTick};

use crate::{
    files::{intent::Lengths, session::SessionCommand},
    recording::{
        objects::RecordedObjects,
        stage::FrameSight,
        timeline_mark::{TimelineMark, TimelineTail},
    },
};

/// The progress of a recording at a moment.
#[derive(Clone, Debug)]
pub(crate) struct RecordingProgress {
    pub(crate) files: Lengths,
    pub(crate) objects: RecordedObjects,
    /// The sight at the last frame.
    pub(crate) sight: FrameSight,
    pub(crate) last_joints: Option<Vec<JointState>>,
    pub(crate) is_paused: bool,
    pub(crate) tick: SimTick,
    /// The tick and phase of the last command in the session log.
    pub(crate) last: Option<(SimTick, CommandSystems)>,
    /// The marks of the tick's segments, at the end of the session log.
    pub(crate) marks: Vec<u8>,
}

/// The moment before a segment began.
#[derive(Clone, Debug)]
pub(crate) struct SegmentStart {
    pub(crate) before: RecordingProgress,
    pub(crate) timeline: TimelineMark,
    /// The commands in the session log in place of the one that began it, if the recording goes on from here: a grasp that takes an
    /// object out of another hand is a release and a grasp, in segments of their own.
    pub(crate) released: Vec<SessionCommand>,
}

/// A segment that can be brought back.
#[derive(Clone, Debug)]
pub(crate) struct UndoneSegment {
    pub(crate) start: SegmentStart,
    pub(crate) end: RecordingProgress,
    pub(crate) timeline: TimelineTail,
}
