//! The last tick of a recording that has no end, because the program was killed or its disk was full.

use std::{io, path::Path};

use tabletop_core::{RecordingCommand, SimCommand, SimTick};
use tabletop_storage::is_taken;

use crate::{
    error::RecorderError,
    files::{
        folder::Folder,
        frame::FrameClock,
        joints,
        limits::MOST_EVENT_BYTES,
        log_file::{read_whole_lines, whole_lines},
        session::Session,
        states,
    },
};

/// Lines of states and joints are shorter.
const LONGEST_LINE: u64 = 1 << 16;

/// Ids do not have more lines.
const MOST_LINES_OF_A_ROW: usize = 64;

impl Session {
    /// True if the recording has come to its end.
    pub fn is_finished(&self) -> bool {
        let last = self.commands.last();
        last.is_some_and(|last| last.command == SimCommand::Recording(RecordingCommand::Finish))
    }

    /// The last tick of which something is in the files of the recording in this folder.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn last_tick(&self, folder: impl AsRef<Path>) -> Result<SimTick, RecorderError> {
        let folder = Folder::existing(folder.as_ref());
        let start = SimTick(self.header.start_tick);
        let commanded = self.commands.last().map(|last| last.tick);
        let frame = last_frame(&folder)?;
        let framed = frame.map(|frame| FrameClock { start }.tick(frame).0);
        let stated = last_tick_of(&folder, &folder.states(), states::header().len())?;
        let moved = last_tick_of(&folder, &folder.joints(), joints::header().len())?;
        let last = [commanded, framed, stated, moved].into_iter().flatten();
        Ok(last.max().map_or(start, SimTick))
    }
}

/// The last frame of which there is a picture or a `move` line.
fn last_frame(folder: &Folder) -> Result<Option<u64>, RecorderError> {
    let mut last = None;
    for segment in 0.. {
        let text = folder.text(segment);
        if !is_taken(&text) {
            break;
        }
        let events = read_whole_lines(&text, MOST_EVENT_BYTES)?;
        let frames = events.lines().filter_map(|line| {
            let (frame, event) = line.split_once(',')?;
            frame.parse().ok().filter(|_| event.starts_with("move,"))
        });
        last = last.max(frames.max());
        let pictured = folder.pictured_frames(segment)?;
        last = last.max(pictured.into_iter().map(|(frame, _)| frame).max());
    }
    Ok(last)
}

/// The tick with which the last row of a file begins, of so many columns.
fn last_tick_of(
    folder: &Folder,
    path: &Path,
    columns: usize,
) -> Result<Option<u64>, RecorderError> {
    let end = end_of(folder, path).map_err(RecorderError::read(path))?;
    Ok(last_tick_in(&end, columns))
}

fn last_tick_in(end: &[u8], columns: usize) -> Option<u64> {
    let end = String::from_utf8_lossy(whole_lines(end));
    let lines: Vec<_> = end.split_inclusive('\n').collect();
    // A quoted id may have line ends.
    let rows = (0..lines.len()).rev().map(|first| lines[first..].concat());
    rows.take(MOST_LINES_OF_A_ROW).find_map(|row| {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .from_reader(row.as_bytes());
        let record = reader.records().next()?.ok()?;
        (record.len() == columns).then(|| record[0].parse().ok())?
    })
}

fn end_of(folder: &Folder, path: &Path) -> io::Result<Vec<u8>> {
    let mut file = folder.storage().open_to_read(path)?;
    let length = file.byte_count()?;
    file.read_from(length.saturating_sub(LONGEST_LINE), 2 * LONGEST_LINE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_tick_is_found_with_any_ids() {
        for (text, tick) in [
            ("tick,id,x\n", None),
            ("tick,id,x\n3,a,1.0\n", Some(3)),
            ("tick,id,x\n3,a,1.0\n4,a,2", Some(3)),
            ("3,a,1.0\n12,\"x\n99\",1.0\n", Some(12)),
            ("", None),
        ] {
            assert_eq!(last_tick_in(text.as_bytes(), 3), tick, "{text}");
        }
    }
}
