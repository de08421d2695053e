//! How far a recording has come, for undo and redo.

use tabletop_core::{JointState, SimTick};

use crate::{
    files::{intent::Lengths, session::SessionCommand},
    recording::{
        objects::RecordedObjects,
        stage::Sight,
        timeline_mark::{TimelineMark, TimelineTail},
    },
};

/// How far a recording had come.
#[derive(Clone, Debug)]
pub(crate) struct Progress {
    pub(crate) files: Lengths,
    pub(crate) objects: RecordedObjects,
    /// What there was to be seen at the last frame.
    pub(crate) sight: Sight,
    pub(crate) last_joints: Option<Vec<JointState>>,
    pub(crate) is_paused: bool,
}

/// The moment before a segment began.
#[derive(Clone, Debug)]
pub(crate) struct SegmentStart {
    pub(crate) before: Progress,
    pub(crate) timeline: TimelineMark,
    /// What the session log says instead of the command that began it, if the recording goes on from here: a grasp that takes an
    /// object out of another hand is a release and a grasp, in segments of their own.
    pub(crate) released: Vec<SessionCommand>,
    pub(crate) tick: SimTick,
}

/// A segment that can be brought back.
#[derive(Clone, Debug)]
pub(crate) struct UndoneSegment {
    pub(crate) start: SegmentStart,
    pub(crate) end: Progress,
    pub(crate) timeline: TimelineTail,
}
