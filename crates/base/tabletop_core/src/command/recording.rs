//! Commands to the recorder.

use serde::{Deserialize, Serialize};

/// A command to the recorder, or to its stand-in. Recordings hold none of these but the one that ends them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordingCommand {
    /// Begin to record.
    Start,
    /// End the recording.
    Finish,
}
