//! Edits of the open recording, as the user asks for them and watches them.

use std::ops::RangeInclusive;

use bevy::prelude::*;

/// A request of the user about the segments of the open recording. The crate that simulates recordings again reads it.
#[derive(Message, Clone, Debug, PartialEq, Eq)]
pub enum EditOrder {
    /// Edit it.
    Edit(TimelineEdit),
    /// Take back the last edit.
    Undo,
    /// Bring back the edit that was taken back last.
    Redo,
    /// Save the edited recording beside the original one.
    Save,
}

/// An edit of the segments of a recording, by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TimelineEdit {
    /// Leave out these segments.
    Delete(RangeInclusive<usize>),
    /// Let two runs of segments change places.
    Swap(RangeInclusive<usize>, RangeInclusive<usize>),
    /// Let a segment take another time.
    Retime {
        /// Its number.
        segment: usize,
        /// The time, in ticks.
        ticks: u64,
    },
}

/// The edits of the open recording. The crate that simulates recordings again sets it.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Editing {
    /// The edit that is being simulated, or the recording that is being saved, in words.
    pub present: Option<String>,
    /// Number of edits that can be taken back.
    pub undoable: usize,
    /// Number of edits that can be brought back.
    pub redoable: usize,
    /// True if what is open was edited and not saved.
    pub is_unsaved: bool,
}
