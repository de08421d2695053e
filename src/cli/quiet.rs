//! The last line of a command: what it has done.

use std::{fmt, path::Path};

use crate::{core::TICKS_PER_SECOND, recorder::RecordingReader};
use clap::Args;

use super::{counted::counted, terminal::say};

#[derive(Args)]
pub(super) struct QuietOption {
    /// Leave out the last line, which sums up what was done
    #[arg(long = "quiet", short)]
    is_quiet: bool,
}

impl QuietOption {
    pub const fn is_quiet(&self) -> bool {
        self.is_quiet
    }

    /// Says what was done.
    pub fn sum_up(&self, done: impl fmt::Display) {
        if !self.is_quiet {
            say(format_args!("tabletop: {done}"));
        }
    }

    /// Says which recording was made.
    pub fn sum_up_recording(&self, folder: &Path) {
        let Ok(recording) = RecordingReader::open(folder) else {
            return;
        };
        let segments = recording.session().segments.len() + 1;
        let seconds = seconds_of(&recording);
        let segments = counted(segments, "segment");
        let folder = folder.display();
        self.sum_up(format_args!(
            "{folder}: recorded {segments}, {seconds:.1} s"
        ));
    }
}

/// The simulated time of a recording, in s.
pub(super) fn seconds_of(recording: &RecordingReader) -> f64 {
    let ticks = recording.last_tick().0 + 1 - recording.first_tick().0;
    ticks as f64 / f64::from(TICKS_PER_SECOND)
}
