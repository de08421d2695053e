//! Commands to the history.

use serde::{Deserialize, Serialize};

/// A command to the history of the world. It is not a [`RecordingCommand`](crate::RecordingCommand), although it changes the
/// present recording: the history carries it out, and the recorder follows the facts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum HistoryCommand {
    /// Go back to the beginning of the recording's present segment, and discard the segment.
    Undo,
    /// Bring back the segment that was undone last.
    Redo,
}
