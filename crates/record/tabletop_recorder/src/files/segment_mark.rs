//! Beginnings of segments in the session log.

use serde::{Deserialize, Serialize};
use tabletop_core::SimTick;

use crate::{
    error::RecorderError,
    files::json::{from_json, to_json_line},
};

/// A line of the session log that says when a segment began.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SegmentMark {
    /// The segment's number. The first segment, which begins with the recording, has no mark.
    pub(crate) segment: u32,
    /// Its first tick.
    pub(crate) tick: u64,
}

impl SegmentMark {
    /// The beginning of its line; that of a command begins with a tick.
    const BEGIN: &str = "{\"segment\":";

    /// True if a line is a mark.
    pub(crate) fn is_in(line: &str) -> bool {
        line.starts_with(Self::BEGIN)
    }

    /// Its line.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn line(segment: u32, tick: SimTick) -> Result<Vec<u8>, RecorderError> {
        let mark = Self {
            segment,
            tick: tick.0,
        };
        to_json_line(&mark).map_err(|source| RecorderError::Command {
            tick: tick.0,
            command: format!("{mark:?}"),
            source,
        })
    }

    /// The tick in which a segment began, by the lines of a session log.
    pub(crate) fn find(log: &str, segment: u32) -> Option<SimTick> {
        let lines = log.lines().filter(|line| Self::is_in(line));
        let mut marks = lines.filter_map(|line| from_json::<Self>(line.as_bytes()).ok());
        let mark = marks.find(|mark| mark.segment == segment)?;
        Some(SimTick(mark.tick))
    }

    /// The lines of a session log that are commands.
    pub(crate) fn without_marks(log: &[u8]) -> Vec<u8> {
        let lines = log.split_inclusive(|&byte| byte == b'\n');
        let commands = lines.filter(|line| !line.starts_with(Self::BEGIN.as_bytes()));
        commands.flatten().copied().collect()
    }
}
