//! Recordings that were cut off or are not finished yet.

use crate::recorder::RecordingReader;

use super::terminal::say;

/// Reports that a recording was cut off or is still being made, if so, and how far it goes. `used` is its use, such as `replayed`.
pub(super) fn say_if_cut_off(recording: &RecordingReader, used: &str) {
    if let Some(tick) = recording.cut_off_at() {
        let folder = recording.folder().display();
        let how = match recording.is_being_made() {
            true => "is still being recorded, is now",
            false => "was cut off",
        };
        say(format_args!(
            "tabletop: {folder} {how} in tick {}, and is {used} that far",
            tick.0
        ));
    }
}
