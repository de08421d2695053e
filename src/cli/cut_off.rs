//! Recordings that were cut off.

use crate::recorder::RecordingReader;

use super::terminal::say;

/// Reports that a recording was cut off, if it was, and how far it goes. `used` is its use, such as `replayed`.
pub(super) fn say_if_cut_off(recording: &RecordingReader, used: &str) {
    if let Some(tick) = recording.cut_off_at() {
        let folder = recording.folder().display();
        say(format_args!(
            "tabletop: {folder} was cut off in tick {}, and is {used} that far",
            tick.0
        ));
    }
}
