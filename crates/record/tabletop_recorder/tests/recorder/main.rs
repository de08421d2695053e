//! Recordings as they are on disk.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod faults;
mod files;
mod hand_pictures;
mod kill;
mod reading;
mod stage;
mod starting;
mod undo;
