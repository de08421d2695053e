//! Recordings, read as learners read them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod demonstration;
mod episode;
mod pictures;
mod program;
