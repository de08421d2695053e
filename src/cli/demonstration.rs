//! Demonstrations of recordings, of this program and of the original one.

use std::path::Path;

use crate::{
    recorder::{RecorderError, RecordingReader, TICKS_PER_FRAME, read_original},
    task::{Demonstration, Furniture},
};

use super::cut_off::say_if_cut_off;

/// The demonstration of a recording. One that was cut off is reported.
pub(super) fn read_demonstration(
    recording: &Path,
    furniture: &Furniture,
) -> Result<Demonstration, RecorderError> {
    if let Some(segments) = read_original(recording)? {
        let shown = Demonstration::of_events(&segments, TICKS_PER_FRAME, furniture);
        return Ok(shown);
    }
    let recording = RecordingReader::open(recording)?;
    say_if_cut_off(&recording, "explained");
    Demonstration::of(&recording)
}
