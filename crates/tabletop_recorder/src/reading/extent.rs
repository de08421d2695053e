//! How far a recording goes that has no end, because the program was killed or its disk was full.

use std::{
    fs::File,
    io::{Read as _, Seek as _, SeekFrom},
    path::Path,
};

use tabletop_core::{RecordingCommand, SimCommand, SimTick};

use crate::{
    error::RecorderError,
    files::{
        folder::Folder,
        frame::FrameClock,
        log_file::{read_whole_lines, whole_lines},
        session::Session,
    },
};

/// Lines of states and joints are shorter.
const LONGEST_LINE: u64 = 4096;

impl Session {
    /// Whether the recording has come to its end.
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
        let stated = last_tick_of(&folder.states())?;
        let moved = last_tick_of(&folder.joints())?;
        let last = [commanded, framed, stated, moved].into_iter().flatten();
        Ok(last.max().map_or(start, SimTick))
    }
}

/// The last frame of which there is a picture or a `move` line.
fn last_frame(folder: &Folder) -> Result<Option<u64>, RecorderError> {
    let mut last = None;
    for segment in 0.. {
        let text = folder.text(segment);
        if !text.exists() {
            break;
        }
        let events = read_whole_lines(&text)?;
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

/// The tick with which the last line of a file begins.
fn last_tick_of(path: &Path) -> Result<Option<u64>, RecorderError> {
    let end = end_of(path).map_err(RecorderError::read(path))?;
    let end = String::from_utf8_lossy(whole_lines(&end));
    let tick = |line: &str| line.split(',').next()?.parse().ok();
    Ok(end.lines().last().and_then(tick))
}

fn end_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(LONGEST_LINE)))?;
    let mut end = Vec::new();
    file.read_to_end(&mut end)?;
    Ok(end)
}
