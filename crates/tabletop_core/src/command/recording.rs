//! Commands to the recorder.

use serde::{Deserialize, Serialize};

/// A command to the recorder, or to what stands in for it. Recordings do not hold these, but for the one that ends them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordingCommand {
    /// Begin to record.
    Start,
    /// End the recording.
    Finish,
}
