//! Commands to the history.

use serde::{Deserialize, Serialize};

/// A command to what keeps the world as it was. It is no [`RecordingCommand`](crate::RecordingCommand), although it concerns the
/// present recording: another part of the simulator carries it out, and the recorder follows the facts that come of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum HistoryCommand {
    /// Go back to where the present segment of the recording began, and discard it.
    Undo,
    /// Bring back the segment that was undone last.
    Redo,
}
