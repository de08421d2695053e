//! Recordings of the original program: events and pictures, and no session log.

use std::path::Path;

use tabletop_core::SimTick;
use tabletop_storage::is_taken;

use crate::{
    error::RecorderError,
    files::{folder::Folder, frame::TICKS_PER_FRAME},
    reading::{
        event::CommaStyle,
        recording_reader::read_events,
        segment::{HandContents, RecordedSegment},
    },
};

/// The segments of a recording of the original program, or of any that consists of events alone; none if the folder holds another one. Frames
/// count quarters of a second; an act is between the frame before and the one that shows it.
///
/// # Errors
/// A file cannot be read, or a line of it is no event; it is named.
pub fn read_original(
    folder: impl AsRef<Path>,
) -> Result<Option<Vec<RecordedSegment>>, RecorderError> {
    let folder = Folder::existing(folder.as_ref());
    if is_taken(&folder.session()) || !is_taken(&folder.text(0)) {
        return Ok(None);
    }
    let mut segments = Vec::new();
    let mut hands = HandContents::default();
    for number in 0.. {
        let Some(events) = read_events(&folder, number, CommaStyle::Escaped)? else {
            break;
        };
        let act = hands.follow(&events);
        let before = events.first().map_or(0, |event| event.frame).checked_sub(1);
        let start = before.map_or(0, |frame| frame.saturating_mul(TICKS_PER_FRAME) + 1);
        segments.push(RecordedSegment {
            number,
            start: SimTick(start),
            act,
            frames: Vec::new(),
            events,
        });
    }
    Ok(Some(segments))
}
